#include <fmt/format.h>
#include "tools/command/command.h"
#include "tools/compare/several.h"

namespace loopwright {
namespace {

struct CompareArguments {
  DiagramArguments diagram;
  std::vector<std::string> experiments;
  std::string json, report;
};

int run(const CompareArguments& a) {
  require_writable(a.json, "--json");
  require_writable_file(a.report, "--report");
  reject_swapped(a.diagram.path, a.experiments);
  Progress progress("compare");
  RunOptions options;
  options.interrupt = &interruption();
  options.progress = [&](double time, double stop) { progress.show(time, stop); };
  const SeveralComparisons all = compare(a.diagram.path, a.experiments, a.diagram.options(), options);
  progress.finish();
  for (const Comparison& comparison : all.records)
    for (const std::string& warning : comparison.warnings) tell("warning: {}\n", warning);
  if (!a.report.empty()) report::write_html(a.report, comparison_page(all, all.records.front().plan->title));
  give_answer(
      to_text(all), a.json, [&] { return to_json(all); }, a.report);
  for (const Comparison& comparison : all.records) {
    if (comparison.run.status == RunStatus::finished) continue;
    tell("{}: {}\n", a.diagram.path, comparison.run.message);
    return comparison.run.status == RunStatus::interrupted ? interrupted : run_failed;
  }
  return done;
}

}  // namespace

void add_compare(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command = app.add_subcommand("compare", "Hold a diagram against a recording");
  auto a = std::make_shared<CompareArguments>();
  a->diagram.add_to(*command);
  command->add_option("experiments", a->experiments, "Experiment files (JSON), one or more")->required();
  command->add_option("--json", a->json, "Write the figures as JSON; - for stdout");
  command->add_option("--report", a->report, "Write an HTML page with overlays and residuals");
  command->callback([=] { choose([=] { return run(*a); }); });
}

}  // namespace loopwright
