/// The engine on the common job, compared with the same job written by hand. Both must give the same motion.
#include <fmt/format.h>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include "engine/run/simulation.h"
#include "tests/benchmarks/common_job_by_hand.h"
#include "tests/benchmarks/diagram_file.h"
#include "tests/benchmarks/measure.h"

namespace loopwright::benchmarks {
namespace {

constexpr double relative_tolerance = 1e-8, absolute_tolerance = 1e-10;

std::string path_of(const std::string& name) {
  return std::string(LOOPWRIGHT_SOURCE) + "/diagrams/linear_motor/" + name;
}

/// The sampled job for a variable-step solver, which accepts no "step".
std::string with_dormand_prince() {
  std::ifstream file(path_of("common_job.json"));
  auto json = nlohmann::json::parse(file);
  json["solver"] = {{"method", "dopri5"},
                    {"relative_tolerance", relative_tolerance},
                    {"absolute_tolerance", absolute_tolerance},
                    {"stop", 2.6}};
  return json.dump();
}
std::shared_ptr<const Plan> without_quantiser(const std::string& path) {
  LoadOptions options;
  options.set = {{"encoder.resolution", "0"}};
  return load_plan(path, options);
}
by_hand::Job job_without_quantiser() {
  by_hand::Job job;
  job.encoder_resolution = 0;
  return job;
}

by_hand::Outcome simulated(const Plan& plan) {
  const RunResult result = simulate(plan);
  if (result.status != RunStatus::finished) return {NAN, NAN};
  by_hand::Outcome outcome{result.recording.find("stage.position")->values.back(), 0};
  for (double e : result.recording.find("error.sum")->values)
    outcome.peak_error = std::max(outcome.peak_error, std::fabs(e));
  return outcome;
}

/// Whether both motions agree; otherwise the benchmark ends with an error.
bool agree(benchmark::State& state, const by_hand::Outcome& engine, const by_hand::Outcome& hand,
           double relative, double absolute = 0) {
  const auto close = [&](double a, double b) {
    return std::fabs(a - b) <= std::max(relative * std::fabs(b), absolute);
  };
  if (close(engine.final_position, hand.final_position) && close(engine.peak_error, hand.peak_error))
    return true;
  state.SkipWithError(
      fmt::format(
          "the engine reaches {:.13f} m with {:.9f} µm, the hand-written code {:.13f} m with {:.9f} µm",
          engine.final_position, engine.peak_error * 1e6, hand.final_position, hand.peak_error * 1e6)
          .c_str());
  return false;
}
/// [m] Below a count of the encoder there is no feedback, and the falling slopes of the cogging force let two
/// solutions diverge: the rounding differences of two orders of summation grow to about 1e-10 m. Without a
/// quantizer they stay at rounding level.
constexpr double below_a_count = 2e-9;

void report_pairs(benchmark::State& state, const std::string& key, const Pairs& pairs, double repeats,
                  double bar, std::string measured, const by_hand::Outcome& outcome) {
  report(state, {key,
                 median(pairs.ratio),
                 bar,
                 std::move(measured),
                 {{"engine_ms", 1e3 * median(pairs.first) / repeats},
                  {"by_hand_ms", 1e3 * median(pairs.second) / repeats},
                  {"pairs", double(pairs.ratio.size())},
                  {"final_position_m", outcome.final_position},
                  {"peak_error_um", 1e6 * outcome.peak_error}}});
}

/// All steps of a run, without recording.
by_hand::Outcome run_steps(Run<double>& run, Number position, Number error) {
  const Plan& plan = run.plan();
  run.reset({plan.seed, 0});
  double peak_error = 0;
  while (run.now().tick < plan.stop_tick) {
    run.step_fixed(plan.stop_tick, false, [] {});
    peak_error = std::max(peak_error, std::fabs(run.number(error)));
  }
  run.evaluate(run.due(), true);
  return {run.number(position), std::max(peak_error, std::fabs(run.number(error)))};
}

void common_job_rk4(benchmark::State& state) {
  const auto plan = load_plan(path_of("common_job.json"));
  Run<double> run(*plan);
  const by_hand::Job job;
  const Number position = plan->find("stage.position").at(0), error = plan->find("error.sum").at(0);
  constexpr int repeats = 8, steps_per_sample = 10;
  by_hand::Outcome engine, hand;
  const Pairs pairs = alternate(
      state,
      [&] {
        for (int i = 0; i < repeats; ++i) engine = run_steps(run, position, error);
      },
      [&] {
        for (int i = 0; i < repeats; ++i) hand = by_hand::run_rk4(job, steps_per_sample);
      });
  if (!agree(state, engine, hand, 0, below_a_count)) return;
  if (!agree(state, simulated(*without_quantiser(path_of("common_job.json"))),
             by_hand::run_rk4(job_without_quantiser(), steps_per_sample), 1e-9))
    return;
  report_pairs(state, "common_job_rk4_ratio", pairs, repeats, 1.1,
               "Run<double>::step_fixed over diagrams/linear_motor/common_job.json, without recording, over "
               "a monolithic loop with RK4 at 10 kHz and "
               "libm; CPU time in turn, median of pairwise ratios",
               engine);
}

void common_job_rk4_recorded(benchmark::State& state) {
  const auto plan = load_plan(path_of("common_job.json"));
  const by_hand::Job job;
  constexpr int repeats = 8, steps_per_sample = 10;
  by_hand::Outcome engine, hand;
  const Pairs pairs = alternate(
      state,
      [&] {
        for (int i = 0; i < repeats; ++i) engine = simulated(*plan);
      },
      [&] {
        for (int i = 0; i < repeats; ++i) hand = by_hand::run_rk4(job, steps_per_sample);
      });
  if (!agree(state, engine, hand, 0, below_a_count)) return;
  report_pairs(state, "common_job_rk4_recorded_ratio", pairs, repeats, 0,
               "simulate() with construction of the run, look at the poles and recording of five signals, "
               "over the same loop without recording",
               engine);
}

void common_job_dopri5(benchmark::State& state) {
  const DiagramFile file(with_dormand_prince());
  const auto plan = load_plan(file.path());
  const by_hand::Job job;
  by_hand::Rows rows(2601);
  constexpr int repeats = 20;
  by_hand::Outcome engine;
  const Pairs pairs = alternate(
      state,
      [&] {
        for (int i = 0; i < repeats; ++i) engine = simulated(*plan);
      },
      [&] {
        for (int i = 0; i < repeats; ++i)
          rows.clear(), by_hand::run_dormand_prince(job, relative_tolerance, absolute_tolerance, rows);
      });
  if (!agree(state, engine, rows.outcome(), 0, below_a_count)) return;
  rows.clear(),
      by_hand::run_dormand_prince(job_without_quantiser(), relative_tolerance, absolute_tolerance, rows);
  if (!agree(state, simulated(*without_quantiser(file.path())), rows.outcome(), 1e-7))
    return;  // as accurate as the tolerance
  report_pairs(state, "common_job_dopri5_ratio", pairs, repeats, 1.5,
               "simulate() with dopri5, 1e-8/1e-10, over a hand-written Dormand-Prince loop that carries its "
               "step across samples; both record five "
               "signals at 1 kHz; CPU time in turn, median of pairwise ratios",
               engine);
}

void common_job_cvode(benchmark::State& state) {
  const auto plan = load_plan(path_of("common_job_continuous.json"));
  const by_hand::Job job;
  by_hand::Rows rows(2601);
  constexpr int repeats = 6;
  by_hand::Outcome engine;
  const Pairs pairs = alternate(
      state,
      [&] {
        for (int i = 0; i < repeats; ++i) engine = simulated(*plan);
      },
      [&] {
        for (int i = 0; i < repeats; ++i)
          rows.clear(), by_hand::run_cvode(job, relative_tolerance, absolute_tolerance, rows);
      });
  if (!agree(state, engine, rows.outcome(), 1e-6)) return;  // as accurate as the tolerance
  report_pairs(
      state, "common_job_cvode_ratio", pairs, repeats, 1.25,
      "simulate() of diagrams/linear_motor/common_job_continuous.json with cvode-bdf, 1e-8/1e-10, over raw "
      "CVODE BDF on a hand-written "
      "right-hand side; same borders of segments, same rows; CPU time in turn, median of pairwise ratios",
      engine);
}

}  // namespace

void add_common_job() {
  benchmark::RegisterBenchmark("common_job_rk4", common_job_rk4)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond)
      ->Iterations(21);
  benchmark::RegisterBenchmark("common_job_rk4_recorded", common_job_rk4_recorded)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond)
      ->Iterations(21);
  benchmark::RegisterBenchmark("common_job_dopri5", common_job_dopri5)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond)
      ->Iterations(21);
  benchmark::RegisterBenchmark("common_job_cvode", common_job_cvode)
      ->UseManualTime()
      ->Unit(benchmark::kMillisecond)
      ->Iterations(21);
}

}  // namespace loopwright::benchmarks
