#include <fmt/format.h>
#include <unistd.h>
#include "engine/record/recording_file.h"
#include "hw/drivers.h"
#include "tools/command/command.h"
#include "tools/deploy/deployment_page.h"

namespace loopwright {
namespace {

struct Arguments {
  DiagramArguments diagram;
  std::string output, report, json;
  int priority = 80, processor = -1;
  bool require_real_time = false, quiet = false;
};

void require_paths(const Arguments& a) {
  require_writable_file(a.output, "-o");
  require_writable_file(a.report, "--report");
  require_writable(a.json, "--json");
  Problems problems;
  if (!a.output.empty() && !is_recording_path(a.output))
    problems.error({}, "", "", fmt::format("-o {}: logs are written as .csv or .mat", a.output));
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

/// One line that is written over on a terminal, a line now and then elsewhere.
void show(const hw::LiveValues& now) {
  const bool on_terminal = isatty(STDERR_FILENO);
  std::string line = fmt::format("{}deploy {:8.2f} s of {:g} s   ", on_terminal ? "\r" : "", now.time, now.stop);
  if (now.has_error) line += fmt::format("error {:+.3e}   ", now.error);
  line += fmt::format("command {:+.3f}   lateness {:6.1f} us{}", now.command, 1e6 * now.lateness_s,
                      on_terminal ? " " : "\n");
  tell_terminal(line);
}

int run(const Arguments& a) {
  require_paths(a);
  const auto plan = load_plan(a.diagram.path, a.diagram.options());
  tell_text(to_text(plan->warnings));
  const hw::Hardware hardware = hardware_of(*plan, a.diagram.path);
  Problems problems;
  auto driver = hw::find_driver(hardware.device->driver)->make(hardware.device, problems);
  if (!driver) throw InputError(std::move(problems));
  hw::IoDevice device(hardware.device, std::move(driver));
  hw::DeployOptions options;
  options.system.priority = a.priority, options.system.processor = a.processor;
  options.require_real_time = a.require_real_time;
  if (!a.quiet) {
    options.progress = show;
    options.ready = [](const std::vector<std::string>& lines) {
      for (const std::string& line : lines) tell("{}\n", line);
    };
  }
  take_time_after_interruption();  // the machine is stopped and the log is written
  const hw::DeployResult result = hw::deploy(*plan, hardware, device, options);
  if (!a.quiet && isatty(STDERR_FILENO)) tell_terminal("\r\033[K");
  if (!a.output.empty()) write_recording(a.output, result.recording);
  if (!a.report.empty()) report::write_html(a.report, deployment_page(*plan, result));
  write_json(a.json, [&] { return to_json(result); });
  if (!a.quiet) give_summary(to_text(result), {a.json});
  if (result.status == RunStatus::finished) return done;
  tell("{}: {}\n", a.diagram.path, result.message);
  return result.status == RunStatus::interrupted ? interrupted : run_failed;
}

}  // namespace

void add_deploy(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command = app.add_subcommand("deploy", "Run a diagram on hardware");
  auto a = std::make_shared<Arguments>();
  a->diagram.add_to(*command);
  command->add_option("-o,--output", a->output, "Write the log: .csv or .mat");
  command->add_option("--report", a->report, "Write an HTML page with scopes and timing");
  command->add_option("--json", a->json, "Write the figures as JSON; - for stdout");
  command->add_option("--priority", a->priority, "Of SCHED_FIFO; 0: the usual scheduling")
      ->check(CLI::Range(0, 99));
  command->add_option("--processor", a->processor, "The loop runs on this one only")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--require-rt", a->require_real_time,
                    "Refuse to move anything unless the system grants all that a loop in real time needs");
  command->add_flag("-q,--quiet", a->quiet, "No progress and no summary");
  command->callback([=] { choose([=] { return run(*a); }); });
}

}  // namespace loopwright
