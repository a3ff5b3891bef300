#include <fmt/format.h>
#include "engine/record/recording_file.h"
#include "tools/command/command.h"
#include "tools/deploy/log_file.h"

namespace loopwright {
namespace {

struct RecoverArguments {
  std::string journal, output;
};

int run(const RecoverArguments& a) {
  require_writable(a.output, "-o");
  if (!is_recording_path(a.output)) {
    Problems problems;
    problems.error({}, "", "", fmt::format("-o {}: logs are written as .csv or .mat", a.output));
    throw InputError(std::move(problems));
  }
  const std::atomic<bool>& interruption_flag = interruption();
  const JournalReader journal(a.journal);
  if (!write_journal_as(a.output, journal, [&] { return interruption_flag.load(); })) return interrupted;
  remark("{}{}: written\n", to_text(journal), a.output);
  const JournalSurvey& survey = journal.survey();
  return survey.lost_rows > 0 || survey.damaged_bytes > 0 ? run_failed : done;
}

}  // namespace

void add_recover(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command =
      app.add_subcommand("recover", "Make a log of the journal that an interrupted deploy left");
  auto a = std::make_shared<RecoverArguments>();
  command->add_option("journal", a->journal, "The journal, as in LOG.csv.journal; it stays as it is")
      ->required();
  command->add_option("-o,--output", a->output, "Write the log: .csv or .mat")->required();
  command->callback([=] { choose([=] { return run(*a); }); });
}

}  // namespace loopwright
