#include "tools/deploy/log_file.h"
#include <fmt/format.h>
#include <filesystem>
#include "engine/json/problem.h"

namespace loopwright {

std::string journal_of(const std::string& target) { return target + ".journal"; }

void require_no_journal(const std::string& journal) {
  std::error_code ignored;
  if (!std::filesystem::exists(std::filesystem::symlink_status(journal, ignored))) return;
  Problems problems;
  auto& p = problems.error(
      {}, "", "",
      fmt::format("{} is there already: the log of a run that did not come to its end, or that "
                  "still goes on",
                  journal));
  p.hint = fmt::format("loopwright recover {} -o FILE.csv makes a log of it; then remove it", journal);
  throw InputError(std::move(problems));
}

std::string to_text(const JournalReader& journal) {
  const JournalSurvey& survey = journal.survey();
  double last_time = 0;
  journal.each_row([&](std::span<const double> row) { return last_time = row[0], true; });
  std::string text = fmt::format("{}: {} rows", journal.path(), survey.rows);
  if (survey.rows > 0)
    text += fmt::format(", up to {} = {:g} {}", journal.heading().columns[0].name, last_time,
                        journal.heading().columns[0].unit);
  text += "\n";
  if (!survey.has_end)
    text += "  its end is missing: the program was ended from outside, or the disk took no more\n";
  if (survey.tail_bytes > 0)
    text += fmt::format("  the last {} bytes belong to no whole part and are left out\n", survey.tail_bytes);
  if (survey.lost_rows > 0 || survey.damaged_bytes > 0)
    text += fmt::format("  damaged: {} rows are lost between others, {} bytes do not check out\n",
                        survey.lost_rows, survey.damaged_bytes);
  if (survey.is_reordered)
    text += "  its parts were in another order in the file; the rows are in the order of their numbers\n";
  if (survey.repeated_bytes > 0)
    text += fmt::format("  {} bytes repeat rows that are there already and are left out\n",
                        survey.repeated_bytes);
  if (survey.dropped_rows > 0)
    text += fmt::format("  {} rows were never written, as the disk did not take them in time\n",
                        survey.dropped_rows);
  return text;
}

}  // namespace loopwright
