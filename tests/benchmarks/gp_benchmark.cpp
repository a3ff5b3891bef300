/// Learned disturbances: speed of training and of prediction.
#include <fmt/format.h>
#include <cmath>
#include <numbers>
#include <random>
#include "models/gp/dense.h"
#include "models/gp/hyperparameters.h"
#include "models/gp/table.h"
#include "engine/run/simulation.h"
#include "tests/benchmarks/diagram_file.h"
#include "tests/benchmarks/measure.h"

namespace loopwright::benchmarks {
namespace {

constexpr double pitch = 0.0225;  // m
const gp::DataScale scale{0.55, pitch, 0.45, 0.05};

gp::Kernel additive() {
  const gp::Shape periodic{gp::Shape::Kind::periodic, 1, pitch},
      smooth{gp::Shape::Kind::squared_exponential, 1, 0};
  return {{gp::Term{1, {periodic, gp::Shape{}}}, gp::Term{1, {gp::Shape{}, smooth}}}, 1};
}

/// Cogging at ten velocities, like the paper's training data.
gp::Samples samples(int count) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::normal_distribution<double> normal;
  gp::Samples result;
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    const double v = 0.05 * (1 + i * 10 / count), x = 0.3 + 0.325 * uniform(random);
    const double angle = 2 * std::numbers::pi * x / pitch;
    result.inputs.push_back({x, v});
    result.labels.push_back(0.76 * (1 - 0.6 * v) * std::sin(angle + 0.4) + 0.2 * std::sin(2 * angle + 0.5) -
                            0.3 * v * v + 0.14 * normal(random));
    sum += result.labels.back();
  }
  for (double& label : result.labels) label -= sum / count;
  return result;
}

gp::Statistics summarised(const gp::Kernel& kernel, const gp::Samples& data) {
  std::string why_not;
  return *gp::summarise(kernel, {0.25, 0.05}, data, why_not);
}

/// From samples to hyper-parameters.
gp::Fit fitted(const gp::Samples& data) {
  const std::vector<gp::Prior> priors = gp::default_priors(additive(), scale);
  const gp::Kernel start = gp::at_medians(additive(), priors);
  const gp::Statistics statistics = summarised(start, data);
  gp::StructuredEvidence evidence(statistics);
  return gp::fit(std::ref(evidence), start, priors);
}

gp::Posterior trained() {
  const gp::Samples data = samples(2096);
  const gp::Kernel kernel = fitted(data).kernel;
  return gp::Posterior(
      {kernel, 0, 0, 0, {gp::Range{0.3, 0.625}, gp::Range{0.05, 0.5}}, summarised(kernel, data)});
}

void fit_2460(benchmark::State& state) {
  const gp::Samples data = samples(2460);
  std::vector<double> seconds;
  gp::Fit fit;
  for (auto _ : state) {
    seconds.push_back(seconds_of([&] { fit = fitted(data); }));
    state.SetIterationTime(seconds.back());
  }
  report(state, {"gp_fit_2460_ms",
                 1e3 * median(seconds),
                 10,
                 "PE(x) + SE(v), 2460 samples: sums, MAP fit of five hyper-parameters; CPU time",
                 {{"evaluations", fit.evaluations}}});
}

void fit_million(benchmark::State& state) {
  const gp::Samples data = samples(1000000);
  std::vector<double> seconds;
  gp::Fit fit;
  for (auto _ : state) {
    seconds.push_back(seconds_of([&] { fit = fitted(data); }));
    state.SetIterationTime(seconds.back());
  }
  report(state, {"gp_fit_1e6_s",
                 median(seconds),
                 1,
                 "the same on a million samples, none left out; CPU time",
                 {{"evaluations", fit.evaluations}}});
}

/// The whole fit against one evaluation with the whole matrix. A dense fit would need as many of these as the
/// structured fit took.
void fit_against_dense(benchmark::State& state) {
  const gp::Samples data = samples(1000);
  gp::Fit fit;
  const Pairs pairs = alternate(
      state, [&] { fit = fitted(data); },
      [&] { benchmark::DoNotOptimize(gp::dense_evidence(additive(), data)); });
  report(state, {"gp_fit_ratio_to_dense",
                 median(pairs.ratio) / fit.evaluations,
                 0.02,
                 "structured fit over a fit of as many evaluations with the whole matrix of 1000 samples",
                 {{"structured_ms", 1e3 * median(pairs.first)},
                  {"one_dense_evaluation_ms", 1e3 * median(pairs.second)}}});
}

constexpr int predictions = 20000;
std::vector<gp::Point> path() {
  std::vector<gp::Point> points;
  for (int i = 0; i < predictions; ++i)
    points.push_back({0.6 * i / predictions, 0.05 + 0.45 * ((i * 7919) % 1000) / 1000});
  return points;
}

template <class F> double nanoseconds_each(benchmark::State& state, F&& f) {
  const std::vector<gp::Point> points = path();
  std::vector<double> nanoseconds;
  for (auto _ : state) {
    double sum = 0;
    const double seconds = seconds_of([&] {
      for (const gp::Point& p : points) sum += f(p);
    });
    benchmark::DoNotOptimize(sum);
    nanoseconds.push_back(1e9 * seconds / predictions);
    state.SetIterationTime(seconds);
  }
  return median(nanoseconds);
}

void mean_by_table(benchmark::State& state) {
  const gp::Posterior posterior = trained();
  const gp::MeanTable table(posterior);
  const double each = nanoseconds_each(state, [&](const gp::Point& p) { return table(p); });
  report(state, {"gp_mean_table_ns",
                 each,
                 30,
                 "posterior mean from two tables, within their bound",
                 {{"bound", table.bound()}, {"bytes", double(table.bytes())}}});
}

void mean_exactly(benchmark::State& state) {
  const gp::Posterior posterior = trained();
  const double each = nanoseconds_each(state, [&](const gp::Point& p) { return posterior.mean(p); });
  report(state, {"gp_mean_exact_ns", each, 0, "posterior mean from the kernel's features", {}});
}

void variance(benchmark::State& state) {
  const gp::Posterior posterior = trained();
  const double each = nanoseconds_each(state, [&](const gp::Point& p) { return posterior.variance(p); });
  report(state, {"gp_variance_ns", each, 1000, "posterior variance, exact", {}});
}

/// The whole controller of the paper with its learned compensation, at 1 kHz. An ideal stage takes the place
/// of the plant, which would be real hardware.
std::string controller_alone() {
  const std::string folder = LOOPWRIGHT_SOURCE "/diagrams/";
  return fmt::format(R"({{
  "loopwright": 1,
  "solver": {{"method": "rk4", "step": 0.001, "stop": 3}},
  "blocks": {{
    "reference":    {{"diagram": "{0}linear_motor/motions/paper.json"}},
    "stage":        {{"type": "Encoder", "sample_time": 0.001, "resolution": 2e-7, "in": {{"position": "reference.position"}}}},
    "velocity":     {{"type": "VelocityEstimator", "sample_time": 0.001, "cutoff": 314, "in": {{"position": "stage.position"}}}},
    "prediction":   {{"type": "Gpr", "model": "{0}examples/gpr.model.json", "lead": {{"value": 2.59, "unit": "ms"}},
                     "in": {{"position": "stage.position", "velocity": "velocity.velocity"}}}},
    "compensation": {{"type": "CompensationFilter", "sample_time": 0.001, "cutoff": 628, "weight": 0.95, "ramp_time": 0.1,
                     "in": {{"prediction": "prediction.prediction"}}}},
    "controller":   {{"diagram": "{0}linear_motor/controller.json",
                     "in": {{"position": "reference.position", "velocity": "reference.velocity",
                            "acceleration": "reference.acceleration", "measured": "stage.position",
                            "compensation": "compensation.compensation"}}}}
  }}
}})",
                     folder);
}

void control_step(benchmark::State& state) {
  const DiagramFile file(controller_alone());
  const auto plan = load_plan(file.path());
  Run<double> run(*plan);
  std::vector<double> microseconds;
  for (auto _ : state) {
    run.reset({plan->seed, 0});
    const double seconds = seconds_of([&] {
      while (run.now().tick < plan->stop_tick) run.step_fixed(plan->stop_tick, false, [] {});
    });
    microseconds.push_back(1e6 * seconds / double(plan->stop_tick));
    state.SetIterationTime(seconds);
  }
  report(state, {"ps_step_us",
                 median(microseconds),
                 2,
                 "one sample of reference, PD, feedforward, disturbance observer, velocity estimate, learned "
                 "compensation and its filter, at 1 kHz",
                 {{"samples", double(plan->stop_tick)}}});
}

}  // namespace

void add_gp() {
  benchmark::RegisterBenchmark("gp_fit_2460", fit_2460)->UseManualTime()->Iterations(30);
  benchmark::RegisterBenchmark("gp_fit_million", fit_million)->UseManualTime()->Iterations(3);
  benchmark::RegisterBenchmark("gp_fit_against_dense", fit_against_dense)->UseManualTime()->Iterations(3);
  benchmark::RegisterBenchmark("gp_mean_by_table", mean_by_table)->UseManualTime()->Iterations(50);
  benchmark::RegisterBenchmark("gp_mean_exactly", mean_exactly)->UseManualTime()->Iterations(20);
  benchmark::RegisterBenchmark("gp_variance", variance)->UseManualTime()->Iterations(20);
  benchmark::RegisterBenchmark("ps_control_step", control_step)->UseManualTime()->Iterations(50);
}

}  // namespace loopwright::benchmarks
