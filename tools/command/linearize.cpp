#include <fmt/format.h>
#include <cmath>
#include <numbers>
#include "engine/record/csv.h"
#include "tools/command/command.h"
#include "tools/linearize/analysis.h"

namespace loopwright {
namespace {

struct LinearizeArguments {
  DiagramArguments diagram;
  LinearizeRequest request;
  double at = -1;
  std::string json, csv, report;
  double measure = 0, settle = 0.5;
};

/// Sine measurements over two decades, below the highest frequency of the plots that ten rows resolve.
void measure(const LinearizeArguments& a, const LinearSystem& system, LinearAnalysis& analysis,
             const RunOptions& options) {
  Problems problems;
  const auto diagram = load_diagram(a.diagram.path, a.diagram.options(), problems);
  if (!diagram) throw InputError(std::move(problems));
  SineTest test;
  test.from = a.request.access.from.at(0), test.to = a.request.access.to.at(0);
  test.amplitude = a.measure, test.settle = a.settle;
  test.sample_time = system.matrices.sample_time > 0 ? system.matrices.sample_time / analysis.lifted
                                                     : std::numbers::pi / (10 * analysis.frequency.back());
  test.holds = system.matrices.sample_time > 0;
  const double highest = std::numbers::pi / (2.5 * test.sample_time);
  for (int i = 12; i >= 0; --i) test.frequencies.push_back(highest * std::pow(10.0, -i / 6.0));
  Progress progress("measure");
  for (size_t i = 0; i < test.frequencies.size() && !*options.interrupt; ++i) {
    SineTest one = test;
    one.frequencies = {test.frequencies[i]};
    analysis.measured.push_back(measure_response(*diagram, one, options)[0]);
    progress.show(double(i + 1), double(test.frequencies.size()));
  }
  progress.finish();
}

int run(const LinearizeArguments& a) {
  require_writable(a.json, "--json");
  require_writable(a.csv, "--csv");
  reject_two_on_stdout({{"--json", a.json}, {"--csv", a.csv}});
  require_writable_file(a.report, "--report");
  const bool has_channel = !a.request.access.from.empty() && !a.request.access.to.empty();
  if (!has_channel && (!a.csv.empty() || a.measure > 0)) {
    Problems problems;
    problems.error({}, "", "", "--csv and --measure show a response: they need --from and --to");
    throw InputError(std::move(problems));
  }
  const auto plan = load_plan(a.diagram.path, a.diagram.options());
  tell_text(to_text(plan->warnings));
  RunOptions options;
  options.interrupt = &interruption();
  LinearizeRequest request = a.request;
  if (a.at >= 0) request.at = a.at;
  LinearAnalysis analysis = analyse(*plan, request, options);
  if (a.measure > 0) measure(a, analysis.system, analysis, options);
  if (a.csv == "-")
    print_csv(stdout, to_recording(analysis));
  else if (!a.csv.empty())
    write_csv(a.csv, to_recording(analysis));
  if (!a.report.empty()) report::write_html(a.report, linear_page(analysis));
  write_json(a.json, [&] { return to_json(analysis); });
  give_summary(to_text(analysis), {a.json, a.csv, a.report});
  return done;
}

}  // namespace

void add_linearize(CLI::App& app, std::function<void(std::function<int()>)> choose) {
  CLI::App* command =
      app.add_subcommand("linearize", "State space, poles, zeros, responses and margins of a diagram");
  auto a = std::make_shared<LinearizeArguments>();
  a->diagram.add_to(*command);
  command->add_option("--from", a->request.access.from, "Ports at which a signal is added")
      ->type_name("PORT");
  command->add_option("--to", a->request.access.to, "Ports that are looked at")->type_name("PORT");
  command
      ->add_option("--open", a->request.access.open, "Ports that are cut: they read the added signal alone")
      ->type_name("PORT");
  command->add_option("--break", a->request.break_point, "Port at which the loop is cut for its margins")
      ->type_name("PORT");
  command->add_option("--at", a->at, "Time of the operating point in s; the start when left out")
      ->check(CLI::NonNegativeNumber);
  command->add_flag("--continuous", a->request.continuous,
                    "The continuous part alone, discrete signals held");
  command
      ->add_option("--sample-time", a->request.sample_time, "Sample a diagram without rates every so many s")
      ->check(CLI::PositiveNumber);
  command
      ->add_option("--measure", a->measure,
                   "Also measure the first response with simulated sines of this amplitude")
      ->check(CLI::PositiveNumber);
  command->add_option("--settle", a->settle, "Seconds before a sine is measured")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--json", a->json, "Write everything as JSON; - for stdout");
  command->add_option("--csv", a->csv, "Write the frequency responses as CSV; - for stdout");
  command->add_option("--report", a->report, "Write an HTML page with Bode and Nyquist plots");
  command->callback([=] { choose([=] { return run(*a); }); });
}

}  // namespace loopwright
