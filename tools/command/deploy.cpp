#include <fmt/format.h>
#include <unistd.h>
#include <cstdio>
#include <filesystem>
#include <optional>
#include "engine/file/output_files.h"
#include "engine/record/atomic_file.h"
#include "engine/record/recording_file.h"
#include "hw/drivers.h"
#include "hw/realtime/detached_call.h"
#include "hw/realtime/stop_signals.h"
#include "tools/command/command.h"
#include "tools/command/interruption.h"
#include "tools/command/output.h"
#include "tools/command/take_over.h"
#include "tools/deploy/console.h"
#include "tools/deploy/deployment_page.h"
#include "tools/deploy/log_file.h"

namespace loopwright {
namespace {

struct DeployArguments {
  DiagramArguments diagram;
  std::string output, report, json;
  int priority = 80, processor = -1;
  bool require_real_time = false, accepts_no_watchdog = false, quiet = false;
  TakeOver take_over;
};

/// A pipe takes its time: opening one waits for a reader, and writing for what it reads.
void reject_pipe(const std::string& path, std::string_view option, Problems& problems) {
  std::error_code none;
  const auto type = std::filesystem::status(path, none).type();
  if (type != std::filesystem::file_type::fifo && type != std::filesystem::file_type::socket) return;
  auto& p = problems.error({}, "", "", fmt::format("{} {}: deploy does not write to a pipe", option, path));
  p.expected = "the name of a file";
  p.hint = "--json - writes the figures to the standard output, which may be a pipe";
}

/// Path of the growing journal: beside the file made from it. Empty: no log was requested, and none is kept.
std::string journal_for(const DeployArguments& a) {
  const std::string& target = a.output.empty() ? a.report : a.output;
  return target.empty() ? "" : journal_of(target);
}

/// A result in the place of the journal would replace the log while it is the only copy.
void reject_journal(const DeployArguments& a, Problems& problems) {
  const std::string journal = journal_for(a);
  for (const auto& [option, path] : {std::pair{"-o", a.output}, {"--report", a.report}, {"--json", a.json}}) {
    if (journal.empty() || path.empty() || path == "-" || !is_same_file(path, journal)) continue;
    auto& p = problems.error({}, "", "", fmt::format("{} {} is the journal of the log", option, path));
    p.hint = "while the loop runs the log grows there; an output needs a file of its own";
  }
}

void require_paths(const DeployArguments& a) {
  require_writable_file(a.output, "-o");
  require_writable_file(a.report, "--report");
  require_writable(a.json, "--json");
  Problems problems;
  reject_pipe(a.output, "-o", problems);
  reject_pipe(a.report, "--report", problems);
  if (a.json != "-") reject_pipe(a.json, "--json", problems);
  if (!a.output.empty() && !is_recording_path(a.output))
    problems.error({}, "", "", fmt::format("-o {}: logs are written as .csv or .mat", a.output));
  reject_journal(a, problems);
  if (problems.has_errors()) throw InputError(std::move(problems));
}

hw::Hardware hardware_of(const Plan& plan, const std::string& diagram) {
  Problems problems;
  hw::Hardware hardware = hw::find_hardware(plan, problems);
  if (hardware.axes.empty()) {
    auto& p = problems.error({}, "", "", fmt::format("{} has no hardware", diagram));
    p.expected = "a HardwareIo block";
    p.hint = "choose the variant that has one, as in --variant stage=quanser";
  }
  if (problems.has_errors()) throw InputError(std::move(problems));
  return hardware;
}

/// One line that is overwritten on a terminal; otherwise a line at intervals.
void show(const hw::LiveValues& now) {
  const bool on_terminal = isatty(STDERR_FILENO);
  std::string text =
      fmt::format("{}deploy {:8.2f} s of {:g} s   ", on_terminal ? "\r" : "", now.time, now.stop);
  if (now.has_error) text += fmt::format("error {:+.3e}   ", now.error);
  text += fmt::format("command {:+.3f}   lateness {:6.1f} us{}", now.command, 1e6 * now.lateness_s,
                      on_terminal ? " " : "\n");
  say(text, 0);
}

/// The answer of a driver that may hang, while signals wait in their queue: a second one 2 s after the first
/// ends the program. Empty: a signal came.
std::optional<hw::Status> answer_of(const std::function<hw::Status()>& call, const hw::StopSignals& signals) {
  hw::Status status;
  hw::DetachedCall detached([&] { status = call(); }, 0);
  detached.run();
  int64_t asked_ns = 0;
  while (!detached.wait(20)) {
    const int signal = signals.wait(0);
    if (signal != 0 && asked_ns != 0 && hw::wall_ns() - asked_ns > 2'000'000'000) hw::end_by(signal);
    if (signal != 0 && asked_ns == 0) asked_ns = hw::wall_ns();
  }
  if (asked_ns != 0) return {};
  return status;
}

/// Opens a device in use if a person agrees; false: nobody agreed, or a signal came. All other problems are
/// reported by deploy().
bool take_over(hw::IoDevice& device, const hw::DriverType& driver, const TakeOver& options,
               const hw::StopSignals& signals) {
  if (!options.is_wanted || !driver.taking_over) return true;
  const auto status = answer_of([&] { return device.open(); }, signals);
  if (!status) return false;
  if (status->code != hw::Code::busy) return true;
  if (!agrees(options, device.describe(*status), driver.taking_over, [&] { return signals.wait(0) != 0; }))
    return false;
  return answer_of([&] { return device.take_over(); }, signals).has_value();
}

/// Without a watchdog a motor stays driven when this process is killed or the computer fails.
void require_watchdog(const hw::DeviceDescription& device) {
  if (device.watchdog.timeout > 0) return;
  Problems problems;
  auto& p = problems.error(device.place, "/watchdog", "", "the device has no watchdog");
  p.expected =
      "\"watchdog\": {\"timeout\": 0.01}: when this program is killed or the computer dies, only the device "
      "itself can put out its safe values";
  p.hint = "--no-watchdog moves without one";
  throw InputError(std::move(problems));
}

/// For readers of messages, after the machine has stopped.
constexpr int patience_ms = 2000;

/// Converts the journal on the disk to the requested files; each is tried, even if others fail.
class Results {
 public:
  Results(const DeployArguments& a, const hw::StopSignals& signals) : a_(a), signals_(signals) {}

  bool write(const Plan& plan, hw::DeployResult& result, const std::string& journal) {
    if (!journal.empty()) attempt([&] { write_log(plan, result, journal); });
    if (a_.json == "-")
      attempt([&] { print(to_json(result)); });
    else if (!a_.json.empty())
      attempt([&] { write_file(a_.json, to_json(result)); });
    return is_good_;
  }

 private:
  template <class Write> void attempt(Write&& write) {
    try {
      write();
    } catch (const InputError& e) {  // its text begins with "error:"
      is_good_ = false;
      say(fmt::format("{}\n", e.what()), patience_ms);
    } catch (const std::exception& e) {
      is_good_ = false;
      say(fmt::format("error: {}\n", e.what()), patience_ms);
    }
  }

  static std::string kept(const std::string& path) {
    return fmt::format("the log is kept in {0}: loopwright recover {0} -o FILE.csv\n", path);
  }
  static std::string kept_or_lost(const std::string& path) {
    if (is_journal(path.c_str())) return kept(path);
    return fmt::format("the log is lost: its journal {} was removed or overwritten during the run\n", path);
  }

  void write_log(const Plan& plan, hw::DeployResult& result, const std::string& path) {
    try {
      if (result.log == hw::LogEnd::stalled) return is_good_ = false, say(kept(path), patience_ms);
      const JournalReader journal(path);
      if (journal.survey().rows > 0) {
        const int64_t begin = hw::wall_ns();
        // A second and third signal in quick succession do not destroy the log.
        const auto stops = [&] { return signals_.wait(0) != 0 && hw::wall_ns() - begin > 2'000'000'000; };
        if (!a_.output.empty() && !write_journal_as(a_.output, journal, stops))
          return is_good_ = false, say(kept_or_lost(path), patience_ms);
        if (!a_.report.empty()) write_report(plan, result, journal);
      } else if (!a_.report.empty()) {
        write_report(plan, result, journal);
      }
      std::remove(path.c_str());
    } catch (...) {
      say(kept_or_lost(path), patience_ms);
      throw;
    }
  }

  void write_report(const Plan& plan, hw::DeployResult& result, const JournalReader& journal) {
    constexpr size_t most_rows = 400'000;
    result.recording = read_journal(journal, most_rows);
    report::Page page = deployment_page(plan, result);
    if (journal.survey().rows > int64_t(most_rows))
      page.facts.push_back({"Signals", fmt::format("least and greatest values of parts of the {} rows",
                                                   journal.survey().rows)});
    report::write_html(a_.report, page);
  }

  /// A reader that does not read is waited for until the next signal.
  void print(const std::string& text) const {
    if (!write_text(STDOUT_FILENO, text, [&] { return signals_.wait(0) != 0; }))
      throw std::runtime_error("the figures cannot be written to the standard output");
  }

  const DeployArguments& a_;
  const hw::StopSignals& signals_;
  bool is_good_ = true;
};

/// Empty if a device in use was not taken over.
std::optional<hw::DeployResult> move(const DeployArguments& a, const Plan& plan, const hw::Hardware& hardware,
                                     const hw::StopSignals& signals, const std::string& journal) {
  Problems problems;
  const hw::DriverType& type = *hw::find_driver(hardware.device->driver);
  auto driver = type.make(hardware.device, problems);
  if (!driver) throw InputError(std::move(problems));
  hw::IoDevice device(hardware.device, std::move(driver));
  if (!take_over(device, type, a.take_over, signals)) {
    answer_of([&] { return device.close(), hw::Status{}; }, signals);
    return {};
  }
  hw::DeployOptions options;
  options.system.priority = a.priority, options.system.processor = a.processor;
  options.require_real_time = a.require_real_time;
  options.journal = journal, options.keeps_log = !journal.empty();
  if (!a.quiet) {
    options.progress = show;
    options.ready = [](const std::vector<std::string>& lines) {
      say(fmt::format("{}\n", fmt::join(lines, "\n")), patience_ms / 2);  // one wait for all of them
    };
  }
  hw::DeployResult result = hw::deploy(plan, hardware, device, options);
  if (!a.quiet && isatty(STDERR_FILENO)) say("\r\033[K", 0);
  return result;
}

int run(const DeployArguments& a) {
  require_paths(a);
  const auto plan = load_plan(a.diagram.path, a.diagram.options());
  tell_text(to_text(plan->warnings));
  const hw::Hardware hardware = hardware_of(*plan, a.diagram.path);
  if (const std::string code = hw::foreign_code_of(*hardware.device); !code.empty())
    say(code + "\n", patience_ms);
  if (!a.accepts_no_watchdog) require_watchdog(*hardware.device);
  const std::string journal = journal_for(a);
  if (!journal.empty()) require_no_journal(journal);
  // Until the process has ended: a repeated signal must not come between the last file and the exit code.
  take_time_after_interruption();
  static const hw::StopSignals& signals = *new hw::StopSignals;
  if (interruption()) return interrupted;  // requested while the diagram was loaded: nothing has moved
  std::optional<hw::DeployResult> moved = move(a, *plan, hardware, signals, journal);
  if (!moved) return run_failed;
  hw::DeployResult& result = *moved;
  const bool is_written = Results(a, signals).write(*plan, result, journal);
  if (result.statistics.dropped_rows > 0 && !journal.empty())
    say(fmt::format("warning: the log lacks {} rows: the disk did not take them in time\n",
                    result.statistics.dropped_rows),
        patience_ms);
  if (!a.quiet) say(to_text(result), patience_ms, a.json == "-" ? STDERR_FILENO : STDOUT_FILENO);
  if (result.status == RunStatus::finished) return is_written ? done : run_failed;
  say(fmt::format("{}: {}\n", a.diagram.path, result.message), patience_ms);
  return result.status == RunStatus::interrupted ? interrupted : run_failed;
}

}  // namespace

void add_deploy(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command = app.add_subcommand("deploy", "Run a diagram on hardware");
  auto a = std::make_shared<DeployArguments>();
  a->diagram.add_to(*command);
  command->add_option("-o,--output", a->output,
                      "Write the log: .csv or .mat. While the loop runs it grows in FILE.journal");
  command->add_option("--report", a->report, "Write an HTML page with scopes and timing");
  command->add_option("--json", a->json, "Write the figures as JSON; - for stdout");
  command->add_option("--priority", a->priority, "Of SCHED_FIFO; 0: the usual scheduling")
      ->check(CLI::Range(0, 99));
  command->add_option("--processor", a->processor, "The loop runs on this one only")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--require-rt", a->require_real_time,
                    "Refuse to move anything unless the system grants all that a loop in real time needs");
  add_take_over(*command, a->take_over);
  command->add_flag(
      "--no-watchdog", a->accepts_no_watchdog,
      "Move a device that has no watchdog: if this program is killed, its outputs stay as they are");
  command->add_flag("-q,--quiet", a->quiet, "No progress and no summary");
  command->callback([=] { choose([=] { return run(*a); }); });
}

}  // namespace loopwright
