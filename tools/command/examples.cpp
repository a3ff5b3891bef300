#include "tools/command/examples.h"
#include <string>
#include <string_view>

namespace loopwright {
namespace {

/// Without the name of the program. Most belong to a folder that `loopwright new` has made.
constexpr std::string_view examples[] = {
    "check nominal.json trial.experiment.json",
    "run nominal.json --report run.html",
    "run nominal.json --set plant.mass=2.1 -o heavy.csv",
    "report before.csv after.csv -o both.html",
    "plan nominal.json",
    "plan nominal.json --svg nominal.svg --depth 1",
    "new axis --from servo",
    "blocks Mass",
    R"(blocks --find "transfer fcn")",
    "schema experiment > experiment.schema.json",
    "schema -o schemas",
    "look measured.csv --report look.html",
    "compare nominal.json trial.experiment.json --report compare.html",
    "fit nominal.json trial.experiment.json --parameters plant.mass,plant.damping -o fitted.json",
    "gp train ps.training.json --model ps.model.json --report ps.html",
    "gp show ps.model.json --on held_out.training.json",
    "diagnose nominal.json trial.experiment.json --report diagnosis.html -o improved.json",
    "sweep payload.sweep.json -o results",
    "sweep report results",
    "sweep merge results",
    "deploy nominal.json --variant stage=card -o log.csv --report log.html",
    "recover log.csv.journal -o log.csv",
    "probe card.device.json",
    "linearize nominal.json --from plant.force --to plant.position --report margins.html",
    R"(design lqr plant.json --from drive.force --allow "drive.position=0.2 mm" --allow "drive.force=100 N" -o feedback.json)",
    R"(design kalman plant.json --from drive.force --to drive.position --deviation "drive.force=2 N" --deviation "drive.position=1 um" -o filter.json)",
    "stability learned.json --report stability.html",
    "studio nominal.json",
    "completion bash > loopwright.bash",
};

/// `path`: the names of the command and of those around it, each with a blank after it.
void add_to(CLI::App& command, const std::string& path) {
  std::string text;
  for (const std::string_view example : examples)
    if (example.starts_with(path)) text.append("\n  loopwright ").append(example);
  if (!text.empty()) command.footer("Examples:" + text);
  for (CLI::App* inner : command.get_subcommands([](const CLI::App*) { return true; }))
    add_to(*inner, path + inner->get_name() + " ");
}

}  // namespace

void add_examples(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    add_to(*command, command->get_name() + " ");
}

}  // namespace loopwright
