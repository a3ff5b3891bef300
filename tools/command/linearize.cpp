#include <fmt/format.h>
#include <cmath>
#include <numbers>
#include "engine/record/csv.h"
#include "engine/run/require_finished.h"
#include "models/linear/structure.h"
#include "tools/command/command.h"
#include "tools/linearize/analysis.h"

namespace loopwright {
namespace {

struct LinearizeArguments {
  DiagramArguments diagram;
  LinearizeRequest request;
  std::string json, csv, report;
  double measure = 0, settle = 0.5;
};

/// Sines run the whole diagram, and need an end of the response to each of them.
void refuse_other_system(const LinearizeArguments& a, const Plan& plan) {
  if (!a.request.continuous || plan.rates.empty()) return;
  Problems problems;
  auto& p = problems.error({}, "", "", "--measure and --continuous show different systems");
  p.expected = "one of them: sines run the diagram with its sampled parts, --continuous leaves these out";
  p.found =
      fmt::format("{} sample time{} in the diagram", plan.rates.size(), plan.rates.size() > 1 ? "s" : "");
  p.hint = "without --continuous both show the whole diagram";
  throw InputError(std::move(problems));
}

[[noreturn]] void refuse_unsettled(const std::string& mode) {
  Problems problems;
  auto& p = problems.error({}, "", "", "--measure: the response to a sine does not settle");
  p.expected = "modes that decay, beside two integrators at most";
  p.found = "the mode at " + mode;
  p.hint = "close a loop around it (without --open), or leave --measure out";
  throw InputError(std::move(problems));
}

/// A sine can be measured where the response to its beginning decays, or ends as a constant or a drift, which
/// one or two integrators leave. Warns where it decays too slowly for `settle`.
void judge_settling(const LinearSystem& system, double settle) {
  constexpr double noticed = 0.01;
  const StateSpace part = connected_part(with_approximate_delays(system.matrices, 6));
  const std::vector<Pole> all = poles(part);
  const double fastest = fastest_of(all), T = part.sample_time;
  const double at_zero = 1e-5 * (T > 0 ? 1 / T : fastest);  // the poles of integrators, with their rounding
  int integrators = 0;
  double slowest = std::numeric_limits<double>::infinity();
  for (const Pole& pole : all) {
    const Stability stability = stability_of(pole, T, fastest);
    const bool integrates = stability == Stability::boundary && pole.frequency <= at_zero;
    integrators += integrates;
    if (stability == Stability::stable)
      slowest = std::min(slowest, -pole.continuous.real());
    else if (!integrates || integrators > 2)
      refuse_unsettled(text_of(pole, T, {}));
  }
  if (const double left = std::exp(-slowest * settle); left > noticed)
    tell(
        "warning: after --settle {:g} s, {:.0f} % of the slowest mode is still in what is measured; --settle "
        "{:.2g} leaves 1 %\n",
        settle, 100 * left, -std::log(noticed) / slowest);
}

/// Of the first channel, which is measured.
LinearSystem measured_system(const LinearizeArguments& a, const Plan& plan, const LinearAnalysis& analysis,
                             const RunOptions& options) {
  const Access& access = a.request.access;
  if (access.from.size() == 1 && access.to.size() == 1) return analysis.system;
  LinearizeRequest one = a.request;
  one.access.from.resize(1), one.access.to.resize(1);
  one.break_point.clear();
  return analyse(plan, one, options).system;
}

/// Sine measurements over two decades, below the highest frequency of the plots that ten rows resolve. An
/// interruption leaves the sines that were measured.
void measure(const LinearizeArguments& a, LinearAnalysis& analysis, const RunOptions& options) {
  Problems problems;
  const auto diagram = load_diagram(a.diagram.path, a.diagram.options(), problems);
  if (!diagram) throw InputError(std::move(problems));
  const StateSpace& matrices = analysis.system.matrices;
  SineTest test;
  test.from = a.request.access.from.at(0), test.to = a.request.access.to.at(0);
  test.open = a.request.access.open, test.at = a.request.at;
  test.amplitude = a.measure, test.settle = a.settle;
  test.holds = matrices.sample_time > 0;
  test.sample_time = test.holds ? matrices.sample_time / analysis.lifted
                                : std::numbers::pi / (10 * analysis.frequency.back());
  const double highest = std::numbers::pi / (2.5 * test.sample_time);
  for (int i = 12; i >= 0; --i) test.frequencies.push_back(highest * std::pow(10.0, -i / 6.0));
  analysis.sines = test.frequencies.size();
  Progress progress("measure");
  try {
    for (double frequency : test.frequencies) {
      SineTest one = test;
      one.frequencies = {frequency};
      analysis.measured.push_back(measure_response(*diagram, one, options)[0]);
      progress.show(double(analysis.measured.size()), double(analysis.sines));
    }
  } catch (const Interrupted&) {
    take_time_after_interruption();
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
  if (a.measure > 0) refuse_other_system(a, *plan);
  LinearAnalysis analysis = analyse(*plan, a.request, options);
  if (a.measure > 0) {
    judge_settling(measured_system(a, *plan, analysis, options), a.settle);
    measure(a, analysis, options);
  }
  if (a.csv == "-")
    print_csv(stdout, to_recording(analysis));
  else if (!a.csv.empty())
    write_csv(a.csv, to_recording(analysis));
  if (!a.report.empty()) report::write_html(a.report, linear_page(analysis));
  write_json(a.json, [&] { return to_json(analysis); });
  give_summary(to_text(analysis), {a.json, a.csv, a.report});
  return analysis.measured.size() < analysis.sines ? interrupted : done;
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
  command->add_option("--at", a->request.at, "Time of the operating point in s; the start when left out")
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
