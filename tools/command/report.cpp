#include <filesystem>
#include <fmt/format.h>
#include <set>
#include "engine/record/column_units.h"
#include "engine/record/recording_file.h"
#include "engine/record/time_names.h"
#include "tools/command/command.h"
#include "tools/command/named_recordings.h"
#include "tools/run/run_page.h"

namespace loopwright {

std::vector<NamedRecording> named(const std::vector<std::string>& paths,
                                  const std::vector<Recording>& recordings) {
  std::set<std::string> names;
  for (const std::string& path : paths) names.insert(std::filesystem::path(path).filename().string());
  std::vector<NamedRecording> list;
  for (size_t i = 0; i < recordings.size(); ++i)
    list.push_back(
        {names.size() == paths.size() ? std::filesystem::path(paths[i]).filename().string() : paths[i],
         &recordings[i]});
  return list;
}

namespace {

/// Pages plot everything over the first column in s: a time in ms, or one behind another column, must not be
/// taken as it stands.
void require_time_first(Recording& recording, const std::string& path, Problems& problems) {
  Problems own;
  const bool has_time = put_time_first(recording, [&](std::string message) -> Problem& {
    return own.error({std::make_shared<SourceFile>(SourceFile{path, {}}), 0}, "", "", std::move(message));
  });
  for (Problem problem : own.list()) {  // those without a cell have hints for experiments
    if (problem.place.file->text.empty())
      problem.hint = "the heading says which column is the time, and in which unit: \"time [ms]\"";
    problems.add(std::move(problem));
  }
  if (!has_time || is_called_time(last_part(recording.columns.front().name))) return;
  auto& p =
      problems.warning({std::make_shared<SourceFile>(SourceFile{path, {}}), 0}, "", "",
                       fmt::format("no column is called time: the first, \"{}\", is taken as the time in s",
                                   recording.columns.front().name));
  p.hint = "if it is none, call the right column \"time [s]\" in the heading";
}

}  // namespace

std::vector<Recording> read_for_page(const std::vector<std::string>& paths) {
  Problems problems;
  std::vector<Recording> recordings;
  for (const std::string& path : paths) {
    const size_t before = problems.list().size();
    Recording recording = read_recording(path, problems, {.allow_not_finite = true, .allow_holes = true});
    if (problems.list().size() == before) require_time_first(recording, path, problems);
    recordings.push_back(std::move(recording));
  }
  if (problems.has_errors()) throw InputError(std::move(problems));
  tell_text(to_text(problems.list()));
  return recordings;
}

void convert_to_units_of(const Recording& first, Recording& other) {
  Problems problems;
  if (!put_time_first(other, [&](std::string message) -> Problem& {
        return problems.error({}, "", "", std::move(message));
      }))
    throw InputError(std::move(problems));
  for (Column& column : other.columns) {
    const Column* const wanted =
        &column == &other.columns.front() ? &first.columns.front() : first.find(column.name);
    if (!wanted || wanted->unit == column.unit) continue;
    const auto from = parse_unit(column.unit), to = parse_unit(wanted->unit);
    if (!from || !to) continue;
    const Conversion between = conversion(*from, *to);
    const bool is_known = between.kind == Conversion::Kind::none || between.kind == Conversion::Kind::turns;
    if (!is_known) continue;
    for (double& value : column.values) value = to->from_si(between(from->to_si(value)));
    column.unit = wanted->unit;
  }
}

namespace {

struct ReportArguments {
  std::vector<std::string> recordings;
  std::string page;
};

int report_recordings(const ReportArguments& a) {
  require_writable_file(a.page, "-o");
  std::vector<Recording> recordings = read_for_page(a.recordings);
  for (size_t i = 1; i < recordings.size(); ++i) convert_to_units_of(recordings[0], recordings[i]);
  report::write_html(a.page, recordings_page(named(a.recordings, recordings)));
  return done;
}

}  // namespace

void add_report(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command = app.add_subcommand("report", "Lay recordings over each other on a page");
  auto a = std::make_shared<ReportArguments>();
  command
      ->add_option("recordings", a->recordings,
                   "Recordings, .csv or .mat; the others are held against the first")
      ->required();
  command->add_option("-o,--output", a->page, "Write this HTML page")->required();
  command->callback([=] { choose([=] { return report_recordings(*a); }); });
}

}  // namespace loopwright
