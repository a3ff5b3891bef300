#include "tools/fit/fit.h"
#include <fmt/format.h>
#include <filesystem>
#include "engine/record/atomic_file.h"
#include "tools/command/command.h"
#include "tools/effects/insert.h"
#include "tools/effects/nest.h"

namespace loopwright {
namespace {

struct Arguments {
  DiagramArguments diagram;
  std::string experiment, json, output;
  std::vector<std::string> parameters;
  int iterations = 40;
};

/// Writes the fitted text to the requested file; relative paths in it still lead to their files.
void write_fitted(const Arguments& a, const std::string& text) {
  if (a.output == "-") {
    answer_data(text);
    return;
  }
  const std::string folder = std::filesystem::path(a.output).parent_path().string();
  write_file(a.output, moved_to_folder({a.diagram.path, text}, folder.empty() ? "." : folder));
}

int run(const Arguments& a) {
  require_writable(a.json, "--json");
  require_writable(a.output, "--output");
  reject_two_on_stdout({{"--json", a.json}, {"--output", a.output}});
  reject_swapped(a.diagram.path, {a.experiment});
  Progress progress("fit");
  FitOptions options;
  options.most_iterations = a.iterations;
  options.interrupt = &interruption();
  options.progress = [&](int iteration, double) { progress.show(iteration, a.iterations); };
  const Fit result = fit(a.diagram.path, a.experiment, a.parameters, a.diagram.options(), options);
  progress.finish();
  if (!a.output.empty()) {
    Problems problems;
    const std::string text = with_fitted_values(a.diagram.path, result, problems);
    if (problems.has_errors()) throw InputError(std::move(problems));
    write_fitted(a, text);
  }
  write_json(a.json, [&] { return to_json(result); });
  give_summary(to_text(result), {a.json, a.output});
  return result.was_interrupted ? interrupted : done;
}

}  // namespace

void add_fit(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command = app.add_subcommand("fit", "Refine parameters so that the simulation meets a recording");
  auto a = std::make_shared<Arguments>();
  a->diagram.add_to(*command);
  command->add_option("experiment", a->experiment, "Experiment file (JSON)")->required();
  command->add_option("--parameters", a->parameters, "Paths as for --set: mass,axis.friction.level")
      ->required()
      ->delimiter(',');
  command->add_option("-o,--output", a->output, "Write the diagram with the fitted values; - for stdout");
  command->add_option("--json", a->json, "Write values and intervals as JSON; - for stdout");
  command->add_option("--iterations", a->iterations, "At most so many iterations")
      ->check(CLI::PositiveNumber);
  command->callback([=] { choose([=] { return run(*a); }); });
}

}  // namespace loopwright
