#include "tools/fit/fit.h"
#include <fmt/format.h>
#include <charconv>
#include <filesystem>
#include <optional>
#include "engine/record/atomic_file.h"
#include "tools/command/command.h"
#include "tools/effects/insert.h"
#include "tools/effects/nest.h"

namespace loopwright {
namespace {

struct FitArguments {
  DiagramArguments diagram;
  std::string json, output, report;
  std::vector<std::string> experiments, parameters, of_each, held_out, ranges;
  bool offsets = false;
  int iterations = 40;
};

/// "mass=80:120"
std::vector<ParameterRange> ranges_of(const std::vector<std::string>& texts) {
  Problems problems;
  std::vector<ParameterRange> ranges;
  for (const std::string& text : texts) {
    const size_t equals = text.find('='), colon = text.find(':', equals == text.npos ? 0 : equals);
    const auto number = [&](size_t from, size_t to) -> std::optional<double> {
      double value = 0;
      const auto [end, code] = std::from_chars(text.data() + from, text.data() + to, value);
      return code == std::errc() && end == text.data() + to ? std::optional(value) : std::nullopt;
    };
    if (equals != text.npos && colon != text.npos) {
      const auto low = number(equals + 1, colon), high = number(colon + 1, text.size());
      if (low && high && *low < *high) {
        ranges.push_back({text.substr(0, equals), *low, *high});
        continue;
      }
    }
    auto& p = problems.error({}, "", "", "--range cannot be read");
    p.expected = "a parameter, and its lowest and highest value in SI units: mass=80:120", p.found = text;
  }
  if (problems.has_errors()) throw InputError(std::move(problems));
  return ranges;
}

/// Writes the fitted text to the requested file; relative paths in it still lead to their files.
void write_fitted(const FitArguments& a, const std::string& text) {
  if (a.output == "-") {
    answer_data(text);
    return;
  }
  const std::string folder = std::filesystem::path(a.output).parent_path().string();
  write_file(a.output, moved_to_folder({a.diagram.path, text}, folder.empty() ? "." : folder));
}

int run(const FitArguments& a) {
  require_writable(a.json, "--json");
  require_writable(a.output, "--output");
  require_writable_file(a.report, "--report");
  reject_two_on_stdout({{"--json", a.json}, {"--output", a.output}});
  reject_swapped(a.diagram.path, a.experiments);
  Progress progress("fit");
  FitOptions options;
  options.most_iterations = a.iterations;
  options.of_each = a.of_each, options.held_out = a.held_out, options.takes_offsets_out = a.offsets;
  options.ranges = ranges_of(a.ranges);
  options.interrupt = &interruption();
  options.progress = [&](int iteration, double) { progress.show(iteration, a.iterations); };
  const Fit result = fit(a.diagram.path, a.experiments, a.parameters, a.diagram.options(), options);
  progress.finish();
  if (result.was_interrupted && result.parameters.empty()) {
    tell("interrupted before anything was fitted: nothing is written\n");
    return interrupted;
  }
  if (!a.output.empty() && !(result.was_interrupted && result.is_as_at_start())) {
    Problems problems;
    const std::string text = with_fitted_values(a.diagram.path, result, problems);
    if (problems.has_errors()) throw InputError(std::move(problems));
    write_fitted(a, text);
    a.diagram.warn_of_settings_left_out(a.output, a.parameters);
  }
  if (!a.report.empty())
    report::write_html(a.report, fit_page(result, std::filesystem::path(a.diagram.path).filename().string()));
  write_json(a.json, [&] { return to_json(result); });
  give_summary(to_text(result), {a.json, a.output, a.report});
  return result.was_interrupted ? interrupted : done;
}

}  // namespace

void add_fit(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command = app.add_subcommand("fit", "Refine parameters so that the simulation meets a recording");
  auto a = std::make_shared<FitArguments>();
  a->diagram.add_to(*command);
  command->add_option("experiments", a->experiments, "Experiment files (JSON), one or more")->required();
  command->add_option("--parameters", a->parameters, "Paths as for --set: mass,axis.friction.level")
      ->delimiter(',');
  command
      ->add_option("--of-each", a->of_each,
                   "Parameters with an own value for every record: initial states, offsets")
      ->delimiter(',');
  command->add_option("--hold-out", a->held_out, "Experiments that are not fitted, only compared");
  command->add_option("--range", a->ranges, "Bounds of a parameter in SI units: mass=80:120");
  command->add_flag("--offsets", a->offsets, "Take the mean error of every compared signal out");
  command->add_option("-o,--output", a->output, "Write the diagram with the fitted values; - for stdout");
  command->add_option("--report", a->report, "Write a page with values, intervals and curves (HTML)");
  command->add_option("--json", a->json, "Write values and intervals as JSON; - for stdout");
  command->add_option("--iterations", a->iterations, "At most so many iterations")
      ->check(CLI::PositiveNumber);
  command->callback([=] { choose([=] { return run(*a); }); });
}

}  // namespace loopwright
