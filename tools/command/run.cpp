#include <fmt/format.h>
#include <filesystem>
#include <optional>
#include <set>
#include "engine/plan/load.h"
#include "engine/record/csv.h"
#include "engine/record/csv_excel.h"
#include "engine/record/recording_file.h"
#include "tools/command/command.h"
#include "tools/deploy/replay.h"
#include "tools/run/judged_run.h"
#include "tools/run/run_page.h"
#include "tools/command/named_recordings.h"
#include "tools/command/watched_files.h"

namespace loopwright {
namespace {

struct RunArguments {
  DiagramArguments diagram;
  std::string output, report, checkpoint, resume, replay;
  std::vector<std::string> beside;
  double checkpoint_every = 0;
  int64_t run = 0;
  bool quiet = false, strict_units = false, watch = false, excel = false;
};

void require_paths(const RunArguments& a) {
  require_writable(a.output, "-o");
  require_writable_file(a.report, "--report");
  require_writable_file(a.checkpoint, "--checkpoint");
  Problems problems;
  if (!a.output.empty() && a.output != "-" && !is_result_path(a.output))
    problems.error({}, "", "", fmt::format("-o {}: recordings are written as .csv, .mat or .h5", a.output));
  if (a.excel && a.output != "-" && !is_csv_path(a.output))
    problems.error({}, "", "", "--excel: a table for Excel is a .csv file").hint =
        "run … -o result.csv --excel";
  if (a.checkpoint.empty() != (a.checkpoint_every == 0))
    problems.error({}, "", "", "--checkpoint FILE and --checkpoint-every SECONDS go together");
  if (problems.has_errors()) throw InputError(std::move(problems));
}

void require_units(const Plan& plan) {
  Problems problems;
  refuse(plan.without_unit, problems);
  if (problems.has_errors()) throw InputError(std::move(problems));
}

/// Compares the plan with the log of a deployment.
int replay_log(const RunArguments& a, const Plan& plan) {
  Problems problems;
  const hw::Hardware hardware = hw::find_hardware(plan, problems);
  if (hardware.axes.empty())
    problems.error({}, "", "", fmt::format("{} has no hardware to replay", a.diagram.path)).hint =
        "choose the variant that was deployed, as in --variant stage=quanser";
  const Recording log = read_recording(a.replay, problems, {.allow_not_finite = true});
  if (problems.has_errors()) throw InputError(std::move(problems));
  const Replay result = replay(plan, hardware, log, problems);
  if (problems.has_errors()) throw InputError(std::move(problems));
  answer("{}", to_text(result));
  return result.explains() ? done : run_failed;
}

/// A simulation opens no device. This is reported, because a loop whose axis does not move looks defective.
void warn_of_hardware(const Plan& plan) {
  for (const Plan::Block& block : plan.blocks)
    if (block.type->info.type == "HardwareIo")
      tell("warning: \"{}\" is hardware and stands still in a simulation; loopwright deploy moves it\n",
           block.path);
}

/// Recordings that a page shows beside the run. They are read before the run, so that a mistake costs no
/// time.
std::vector<Recording> read_beside(const RunArguments& a) {
  if (a.beside.empty() || !a.report.empty()) return read_for_page(a.beside);
  Problems problems;
  problems.error({}, "", "", "--beside lays recordings over the run on a page: it needs --report");
  throw InputError(std::move(problems));
}

/// What --watch keeps from run to run.
struct Watch {
  WatchedFiles files;
  std::optional<report::Page> page;  ///< the last one
};
constexpr int reload_s = 2;  // a page that is read is not torn away too often

/// The diagram and everything that it names.
std::set<std::string> files_of(const Diagram& diagram, const Plan& plan) {
  std::set<std::string> files(diagram.files.begin(), diagram.files.end());
  files.insert(diagram.path);
  for (const FileRead& file : plan.identity.files)
    files.insert((std::filesystem::path(diagram.path).parent_path() / file.path).string());
  return files;
}

int run_once(const RunArguments& a, Watch* watch = nullptr) {
  require_paths(a);
  const auto [diagram, plan] = load_diagram_and_plan(a.diagram.path, a.diagram.options());
  if (watch) watch->files.watch(files_of(*diagram, *plan));
  if (a.strict_units) require_units(*plan);
  tell_text(to_text(plan->warnings));
  if (!a.replay.empty()) return replay_log(a, *plan);
  warn_of_hardware(*plan);
  std::vector<Recording> others = read_beside(a);
  Progress progress("run");
  take_time_after_interruption();  // the computed results are written
  RunOptions options;
  options.run = a.run;
  options.checkpoint_file = a.checkpoint, options.checkpoint_every = a.checkpoint_every,
  options.resume_file = a.resume;
  options.interrupt = &interruption();
  if (!a.quiet) options.progress = [&](double time, double stop) { progress.show(time, stop); };
  const auto [result, figures] = run_and_judge(diagram.get(), *plan, options);
  progress.finish();
  for (const std::string& warning : result.warnings) tell("{}: warning: {}\n", a.diagram.path, warning);
  if (a.output == "-")
    (a.excel ? print_excel_csv : print_csv)(stdout, result.recording);
  else if (a.excel)
    write_excel_csv(a.output, result.recording);
  else if (!a.output.empty())
    write_recording(a.output, result.recording);
  if (!a.report.empty()) {
    for (Recording& other : others) convert_to_units_of(result.recording, other);
    report::Page page = run_page(diagram.get(), *plan, result, figures, named(a.beside, others));
    if (watch) page.reload_s = reload_s;
    report::write_html(a.report, page);
    if (watch) watch->page = std::move(page);
  }
  if (!a.quiet) give_summary(run_summary(*plan, result, figures), {a.output, a.report});
  if (result.status == RunStatus::finished) return done;
  tell("{}: {}\n", a.diagram.path, result.message);
  return result.status == RunStatus::interrupted ? interrupted : run_failed;
}

/// Runs again whenever a file that the run reads is saved, until it is interrupted.
int run_and_watch(const RunArguments& a) {
  Watch watch;
  watch.files.watch({a.diagram.path});
  do {
    try {
      run_once(a, &watch);
    } catch (const InputError& error) {
      tell("{}\n", error.problems.text());
    }
    tell("{}: waiting for a change; Ctrl-C ends\n", a.diagram.path);
  } while (watch.files.wait_for_change(interruption()));
  if (watch.page) {
    watch.page->reload_s = 0;
    report::write_html(a.report, *watch.page);
  }
  return done;
}

int run(const RunArguments& a) { return a.watch ? run_and_watch(a) : run_once(a); }

}  // namespace

void add_run(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command = app.add_subcommand("run", "Simulate a diagram");
  auto a = std::make_shared<RunArguments>();
  a->diagram.add_to(*command);
  command->add_option("-o,--output", a->output,
                      "Write the recording: .csv, .mat, .h5, or - for CSV on stdout");
  command
      ->add_flag("--excel", a->excel, "CSV for a spreadsheet: semicolons, decimal commas, no comment lines")
      ->needs("--output");
  command->add_option("--report", a->report, "Write an HTML page with scopes and statistics");
  command->add_option("--beside", a->beside, "Lay this recording over the run on the page; may be repeated")
      ->allow_extra_args(false);
  command->add_option("--run", a->run, "Number of the run: another one has other noise")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--checkpoint", a->checkpoint, "Set the run aside in this file while it goes on");
  command->add_option("--checkpoint-every", a->checkpoint_every, "Simulated seconds between checkpoints")
      ->check(CLI::PositiveNumber);
  command->add_option("--resume", a->resume, "Go on from a checkpoint, with its number of the run")
      ->excludes("--run");
  command
      ->add_option("--replay", a->replay,
                   "Step the diagram through the log of a deployment: every output must be the logged one, "
                   "bit for bit")
      ->excludes("--output", "--report", "--run", "--checkpoint", "--resume");
  command->add_flag("--strict-units", a->strict_units, "Refuse wires whose unit nothing decides");
  command
      ->add_flag(
          "--watch", a->watch,
          "Run again whenever a file that it reads is saved, and keep the page up to date; Ctrl-C ends")
      ->excludes("--checkpoint", "--resume", "--replay");
  command->add_flag("-q,--quiet", a->quiet, "No progress and no summary");
  command->callback([=] { choose([=] { return run(*a); }); });
}

}  // namespace loopwright
