/// Many runs of the common job: lanes against the engine's scalar run, several threads against one, a sweep
/// against its bare runs.
#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include "tests/benchmarks/common_job_lanes_by_hand.h"
#include "tests/benchmarks/diagram_file.h"
#include "tests/benchmarks/measure.h"
#include "tools/sweep/run_sweep.h"

namespace loopwright::benchmarks {
namespace {

const std::string common_job = std::string(LOOPWRIGHT_SOURCE) + "/diagrams/linear_motor/common_job.json";

constexpr int arenas = 2;  // as in a sweep of many runs

/// All lanes, each with its own payload.
void run_all(LaneRun& run, const Plan& plan) {
  for (int lane = 0; lane < run.lanes(); ++lane) *run.parameter("stage.payload", lane) = 0.01 * lane;
  run.reset({plan.seed, 0});
  run.run();
}

void lane_speedup(benchmark::State& state, InstructionSet set, const std::string& key, double at_least) {
  if (const std::string reason = lanes_unavailable(set); !reason.empty()) {
    state.SkipWithError(reason.c_str());
    return;
  }
  const auto plan = load_plan(common_job);
  const auto scalar = make_lane_run(*plan, InstructionSet::scalar, 1),
             lanes = make_lane_run(*plan, set, arenas);
  const int width = lanes->lanes();
  const Pairs pairs = alternate(
      state,
      [&] {
        for (int i = 0; i < width / 2; ++i) run_all(*scalar, *plan);
      },
      [&] { run_all(*lanes, *plan); });
  const double speedup = 2 * median(pairs.ratio);
  report(state, {key,
                 speedup,
                 0,
                 fmt::format("runs a second on one thread, {} lanes of {} over scalar runs of the engine; "
                             "common job, RK4 at 10 "
                             "kHz, payloads unequal; CPU time in turn, median of pairwise ratios",
                             width, to_name(set)),
                 {{"runs_per_second", width / median(pairs.second)},
                  {"lanes", double(width)},
                  {"pairs", double(pairs.ratio.size())}},
                 at_least});
}

/// Final positions [m] of all lanes.
std::vector<double> final_positions(const LaneRun& run, const Plan& plan) {
  std::vector<double> positions(size_t(run.lanes()));
  run.read(plan.find("stage.position"), positions.data());
  return positions;
}

/// The engine's lanes, compared with loops over the same registers without an engine.
void lane_ratio(benchmark::State& state, InstructionSet set, const std::string& key) {
  if (const std::string reason = lanes_unavailable(set); !reason.empty()) {
    state.SkipWithError(reason.c_str());
    return;
  }
  const auto plan = load_plan(common_job);
  const auto lanes = make_lane_run(*plan, set, arenas);
  const by_hand::Job job;
  const auto reference = by_hand::tabulated_reference(job);
  std::array<std::array<double, 32>, arenas> masses;
  for (size_t lane = 0; lane < 32 * arenas; ++lane)
    masses[lane / 32][lane % 32] = job.mass + 0.01 * double(lane);
  std::array<by_hand::Outcome, 32 * arenas> outcomes;
  const auto by_hand_run =
      set == InstructionSet::avx512 ? by_hand::run_lanes_avx512 : by_hand::run_lanes_avx2;
  const Pairs pairs = alternate(
      state, [&] { run_all(*lanes, *plan); },
      [&] {
        for (size_t i = 0; i < arenas; ++i) by_hand_run(job, reference, 10, masses[i], &outcomes[32 * i]);
      });
  const auto positions = final_positions(*lanes, *plan);
  for (size_t lane = 0; lane < outcomes.size(); ++lane)
    if (!(std::abs(positions[lane] - outcomes[lane].final_position) < 1e-6))
      throw std::runtime_error("the engine's lanes and the hand-written ones end at different places");
  report(state,
         {key,
          median(pairs.ratio),
          1.3,
          fmt::format("time of 64 common jobs on lanes of {}, as in a sweep of many runs, over that of two "
                      "hand-written loops over the same registers, with the same elementary functions and a "
                      "tabulated reference; CPU time "
                      "in turn, median of pairwise ratios",
                      to_name(set)),
          {{"runs_per_second_by_hand", outcomes.size() / median(pairs.second)}}});
}

std::string sweep_text(int runs, double stop) {
  return fmt::format(R"({{"loopwright": 1, "diagram": "{}", "set": {{"solver.stop": {}}},
    "axes": {{"stage.payload": {{"uniform": {{"from": 0, "to": 0.5}}}}}}, "samples": {{"count": {}}},
    "metrics": {{"tracking": {{"rms": "error.sum"}}, "peak": {{"peak": "error.sum"}}}}}})",
                     common_job, stop, runs);
}
SweepPlan plan_of(const DiagramFile& file) {
  Problems problems;
  auto sweep = load_sweep(file.path(), problems);
  if (!sweep) throw InputError(std::move(problems));
  return SweepPlan(std::move(sweep));
}

/// A sweep, on one or several threads, into a temporary folder.
double wall_seconds(const SweepPlan& plan, int threads) {
  const std::string folder =
      (std::filesystem::temp_directory_path() / fmt::format("loopwright_sweep_benchmark_{}", getpid()))
          .string();
  const auto start = std::chrono::steady_clock::now();
  run_sweep(plan, folder, {.threads = threads});
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::filesystem::remove_all(folder);
  return seconds;
}

void thread_speedup(benchmark::State& state) {
  const DiagramFile file(sweep_text(1024, 2.6));
  const SweepPlan plan = plan_of(file);
  Pairs pairs;
  for (auto _ : state) {
    const double one = wall_seconds(plan, 1);
    pairs.add(one, wall_seconds(plan, 2));
    state.SetIterationTime(one);
  }
  const double one = *std::min_element(pairs.first.begin(), pairs.first.end()),
               two = *std::min_element(pairs.second.begin(), pairs.second.end());
  report(state,
         {"sweep_thread_speedup",
          one / two,
          0,
          "wall time of a sweep of 1024 common jobs on one thread over that on two, the shortest of each "
          "taken in turn; needs two idle cores",
          {{"median", median(pairs.ratio)}, {"runs_per_second", 1024 / two}},
          1.8});
}

void overhead(benchmark::State& state) {
  const DiagramFile file(sweep_text(64, 0.5));
  const SweepPlan plan = plan_of(file);
  const auto bare = make_lane_run(*plan.world(0).plan, InstructionSet::scalar, 1);
  const Pairs pairs = alternate(
      state, [&] { make_runs(plan, 0, 64, InstructionSet::scalar); },
      [&] {
        for (int64_t run = 0; run < 64; ++run) {
          *bare->parameter("stage.payload", 0) = plan.design().point(run)[0];
          bare->reset({1, run});
          bare->run();
        }
      });
  report(state, {"sweep_overhead_ratio",
                 median(pairs.ratio),
                 1.1,
                 "CPU time of 64 scalar runs by a sweep, with design, metrics and records, over the bare "
                 "runs; common job cut to "
                 "0.5 s; in turn, median of pairwise ratios",
                 {{"bare_run_ms", 1e3 * median(pairs.second) / 64}}});
}

}  // namespace

void add_sweep() {
  const auto add = [](const char* name, auto f, int iterations) {
    benchmark::RegisterBenchmark(name, f)
        ->UseManualTime()
        ->Unit(benchmark::kMillisecond)
        ->Iterations(iterations);
  };
  add(
      "sweep_lanes",
      [](benchmark::State& s) {
        lane_speedup(s, widest_instruction_set(), "sweep_lane_speedup",
                     widest_instruction_set() == InstructionSet::avx512 ? 9 : 6);
      },
      21);
  add(
      "sweep_lanes_avx2",
      [](benchmark::State& s) { lane_speedup(s, InstructionSet::avx2, "sweep_lane_speedup_avx2", 6); }, 21);
  add(
      "sweep_lane_ratio",
      [](benchmark::State& s) { lane_ratio(s, widest_instruction_set(), "sweep_lane_ratio"); }, 21);
  add(
      "sweep_lane_ratio_avx2",
      [](benchmark::State& s) { lane_ratio(s, InstructionSet::avx2, "sweep_lane_ratio_avx2"); }, 21);
  add("sweep_threads", thread_speedup, 7);
  add("sweep_overhead", overhead, 11);
}

}  // namespace loopwright::benchmarks
