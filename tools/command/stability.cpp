#include "tools/stability/stability.h"
#include "tools/command/command.h"

namespace loopwright {
namespace {

struct StabilityArguments {
  DiagramArguments diagram;
  StabilityRequest request;
  bool no_kicks = false;
  std::string json, report;
};

int run(const StabilityArguments& a) {
  require_writable(a.json, "--json");
  require_writable_file(a.report, "--report");
  StabilityRequest request = a.request;
  request.kicks = !a.no_kicks;
  Progress progress("stability");
  RunOptions options;
  options.interrupt = &interruption();
  options.progress = [&](double time, double stop) { progress.show(time, stop); };
  const StabilityReport result = assess_stability(a.diagram.path, a.diagram.options(), request, options);
  progress.finish();
  if (!a.report.empty()) report::write_html(a.report, stability_page(result));
  give_answer(
      to_text(result), a.json, [&] { return to_json(result); }, a.report);
  return done;
}

}  // namespace

void add_stability(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command = app.add_subcommand(
      "stability", "Whether a loop with a learned compensation is stable, and for how much of it");
  auto a = std::make_shared<StabilityArguments>();
  a->diagram.add_to(*command);
  command
      ->add_option("--disturbance", a->request.disturbance, "Input port of the plant, where it has several")
      ->type_name("PORT");
  command->add_option("--kick", a->request.kick, "Height of the pulse that is added there, SI")
      ->capture_default_str();
  command->add_option("--kick-duration", a->request.kick_duration, "Its length in s")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command->add_flag("--no-kicks", a->no_kicks, "Certificates alone, no kicks");
  command->add_option("--json", a->json, "Write the figures as JSON; - for stdout");
  command->add_option("--report", a->report, "Write an HTML page");
  command->callback([=] { choose([=] { return run(*a); }); });
}

}  // namespace loopwright
