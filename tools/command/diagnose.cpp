#include "tools/diagnose/diagnose.h"
#include <fmt/format.h>
#include "tools/command/command.h"

namespace loopwright {
namespace {

struct DiagnoseArguments {
  DiagramArguments diagram;
  std::vector<std::string> experiments, catalogues, more_catalogues;
  std::string json, report, improved;
  bool trail = false, all = false;
};

int run(const DiagnoseArguments& a) {
  require_writable(a.json, "--json");
  require_writable_file(a.report, "--report");
  require_writable_file(a.improved, "-o");
  reject_swapped(a.diagram.path, a.experiments);
  DiagnoseOptions options;
  options.load = a.diagram.options(), options.catalogues = a.catalogues,
  options.more_catalogues = a.more_catalogues, options.improved_diagram = a.improved,
  options.writes_all = a.all;
  options.interrupt = &interruption();
  Progress progress("diagnose");
  options.progress = [&](const char*, double done) { progress.show(done, 1); };
  const Diagnosis diagnosis = diagnose(a.diagram.path, a.experiments, options);
  progress.finish();
  if (diagnosis.was_interrupted) return interrupted;
  if (a.trail)
    for (const std::string& line : diagnosis.trail) tell("{}\n", line);
  a.diagram.warn_of_settings_left_out(diagnosis.improved);
  if (!a.report.empty()) report::write_html(a.report, diagnosis_page(diagnosis));
  give_answer(
      to_text(diagnosis), a.json, [&] { return to_json(diagnosis); }, a.report);
  return done;
}

}  // namespace

void add_diagnose(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command = app.add_subcommand("diagnose", "Find the physical effect that a diagram lacks");
  auto a = std::make_shared<DiagnoseArguments>();
  a->diagram.add_to(*command);
  command->add_option("experiments", a->experiments, "Experiment files (JSON), one or more")->required();
  command->add_option("--effects", a->catalogues, "Folders with effect files in the place of the catalogue");
  command->add_option("--more-effects", a->more_catalogues, "Folders with effect files beside the catalogue");
  command->add_option("--json", a->json, "Write the diagnosis as JSON; - for stdout");
  command->add_option("--report", a->report, "Write an HTML page that tells the story");
  command->add_option("-o,--output", a->improved, "Write the diagram with the effects that were found");
  command->add_flag("--all", a->all, "Write the optional effects too");
  command->add_flag("--trail", a->trail, "Show what the search tried");
  command->callback([=] { choose([=] { return run(*a); }); });
}

}  // namespace loopwright
