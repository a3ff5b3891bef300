#include <fmt/format.h>
#include <filesystem>
#include "tools/command/command.h"
#include "tools/compare/compare.h"

namespace loopwright {
namespace {

struct Arguments {
  DiagramArguments diagram;
  std::string experiment, json, report;
};

int run(const Arguments& a) {
  require_writable(a.json, "--json");
  require_writable_file(a.report, "--report");
  reject_swapped(a.diagram.path, {a.experiment});
  Progress progress("compare");
  RunOptions options;
  options.interrupt = &interruption();
  options.progress = [&](double time, double stop) { progress.show(time, stop); };
  const Comparison comparison = compare(a.diagram.path, a.experiment, a.diagram.options(), options);
  progress.finish();
  for (const std::string& warning : comparison.warnings) tell("warning: {}\n", warning);
  const std::string title = std::filesystem::path(a.experiment).filename().string();
  if (!a.report.empty())
    report::write_html(a.report, comparison_page(comparison, comparison.plan->title + " — " + title));
  give_answer(
      to_text(comparison), a.json, [&] { return to_json(comparison); }, a.report);
  if (comparison.run.status == RunStatus::finished) return done;
  tell("{}: {}\n", a.diagram.path, comparison.run.message);
  return comparison.run.status == RunStatus::interrupted ? interrupted : run_failed;
}

}  // namespace

void add_compare(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command = app.add_subcommand("compare", "Hold a diagram against a recording");
  auto a = std::make_shared<Arguments>();
  a->diagram.add_to(*command);
  command->add_option("experiment", a->experiment, "Experiment file (JSON)")->required();
  command->add_option("--json", a->json, "Write the figures as JSON; - for stdout");
  command->add_option("--report", a->report, "Write an HTML page with overlays and residuals");
  command->callback([=] { choose([=] { return run(*a); }); });
}

}  // namespace loopwright
