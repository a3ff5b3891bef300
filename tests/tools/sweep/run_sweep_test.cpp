#include <gmock/gmock.h>
#include <cmath>
#include <numeric>
#include "engine/run/simulation.h"
#include "tests/tools/sweep/sweep_testing.h"

namespace loopwright::run_sweep_test {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

TEST(RunSweep, GivesTheSameBitsWhateverTheThreadsAndLanes) {
  const SweepFolder folder(four_axis_values, forty_samples);
  const SweepPlan plan = folder.plan();
  ASSERT_EQ(plan.runs(), 160);
  const auto scalar = bits_with(plan, folder, "scalar", {.instruction_set = InstructionSet::scalar});
  EXPECT_EQ(
      bits_with(plan, folder, "scalar_threads", {.threads = 3, .instruction_set = InstructionSet::scalar}),
      scalar);
  for (const InstructionSet set : {InstructionSet::avx2, InstructionSet::avx512}) {
    if (!lanes_unavailable(set).empty()) continue;
    EXPECT_EQ(bits_with(plan, folder, std::string(to_name(set)), {.threads = 2, .instruction_set = set}),
              scalar)
        << to_name(set);
  }
}

// The results of the sweep must be those of the printed command.
TEST(RunSweep, GivesWhatEachRunGivesByItself) {
  const SweepFolder folder(four_axis_values, forty_samples);
  const SweepPlan plan = folder.plan();
  for (const int64_t run : {0, 33, 100, 159}) {
    const auto alone = plan.plan_of(run);
    RunOptions options;
    options.run = run;
    const RunResult result = simulate(*alone, options);
    const auto& position = result.recording.find("mass.position")->values;
    double squares = 0, sum = 0;
    for (const double x : position) squares += x * x, sum += x;
    const auto made = make_runs(plan, run, run + 1)[0];
    ASSERT_FALSE(made.failed) << made.reason;
    EXPECT_EQ(made.metrics[0], std::sqrt(squares / double(position.size())));
    EXPECT_EQ(made.metrics[1], sum / double(position.size()));
    EXPECT_EQ(made.metrics[2], *std::max_element(position.begin(), position.end()));
    EXPECT_EQ(made.metrics[5], position.back());
    EXPECT_THAT(plan.command(run), HasSubstr(fmt::format("--run {}", run)));
  }
}

/// x = 5 exp(-t/T) is below 0.1 after T ln 50: with T = 0.05 s before the end of the run, with 1 s not.
TEST(RunSweep, ASettlingTimeOfARunThatNeverSettlesIsNoNumber) {
  const SweepFolder folder(
      R"("decay.gain": {"values": [-20, -1]})", "",
      R"("settled": {"settling_time": "x.y", "target": 0, "band": 0.1})",
      R"({"loopwright": 1, "solver": {"method": "rk4", "step": 0.001, "stop": 0.5}, "blocks": {
    "decay": {"type": "Gain", "gain": -1, "in": {"u": "x.y"}},
    "x": {"type": "Integrator", "initial": 5, "in": {"u": "decay.y"}}}})");
  const std::vector<RunRecord> made = make_runs(folder.plan(), 0, 2);
  EXPECT_NEAR(made[0].metrics[0], 0.05 * std::log(50), 1.1e-3);
  EXPECT_TRUE(std::isnan(made[1].metrics[0])) << made[1].metrics[0];
  EXPECT_FALSE(made[1].failed);
}

TEST(RunSweep, PutsShardsTogetherToTheSameTable) {
  const SweepFolder folder(four_axis_values, forty_samples);
  const SweepPlan plan = folder.plan();
  const auto whole = bits_with(plan, folder, "whole", {});
  for (const int64_t shard : {2, 0, 1}) {
    SweepOptions options;
    options.shard = shard, options.shards = 3;
    EXPECT_LT(run_sweep(plan, folder.results("parts"), options).runs, 100);
  }
  const SweepResults merged = read_results(plan, folder.results("parts"));
  EXPECT_EQ(merged.missing, 0);
  EXPECT_EQ(bits_of(merged.table), whole);
}

TEST(RunSweep, GoesOnAfterAnInterruptionAndRepeatsNoRun) {
  const SweepFolder folder(four_axis_values, forty_samples);
  const SweepPlan plan = folder.plan();
  const auto whole = bits_with(plan, folder, "whole", {});
  std::atomic<bool> interrupt = false;
  SweepOptions options;
  options.interrupt = &interrupt;
  options.progress = [&](int64_t done, int64_t) { interrupt = done > 60; };
  const SweepOutcome first = run_sweep(plan, folder.results(), options);
  EXPECT_TRUE(first.interrupted);
  EXPECT_LT(first.done, 160);
  const SweepOutcome second = run_sweep(plan, folder.results(), {.resume = true});
  EXPECT_EQ(first.made + second.made, 160);
  EXPECT_EQ(bits_of(read_results(plan, folder.results()).table), whole);
}

TEST(RunSweep, TurnsAFailedRunIntoARowWithItsReason) {
  const SweepFolder folder(R"("spring.gain": {"values": [40, -1e9, 50]})", "",
                           R"("p": {"peak": "mass.position"})");
  const SweepPlan plan = folder.plan();
  run_sweep(plan, folder.results(), {});
  const SweepResults results = read_results(plan, folder.results());
  ASSERT_EQ(results.failures.size(), 1u);
  EXPECT_EQ(results.failures[0].first, 1);
  EXPECT_THAT(results.failures[0].second, HasSubstr("diverged"));
  EXPECT_EQ(results.failures[0].second, [&] {
    RunOptions options;
    options.run = 1;
    return simulate(*plan.plan_of(1), options).message;
  }());
  EXPECT_TRUE(std::isnan(results.table.find("p")->values[1]));
  EXPECT_TRUE(std::isfinite(results.table.find("p")->values[2]));
}

TEST(RunSweep, RunsVariableStepDiagramsOneByOneAndSaysSo) {
  std::string loop = small_loop;
  const std::string fixed = R"("method": "rk4", "step": 0.01)";
  loop.replace(loop.find(fixed), fixed.size(), R"("method": "dopri5")");
  const SweepFolder folder(R"("mass.mass": {"values": [1, 2, 3]})", "", metrics_of_all_kinds, loop);
  const SweepPlan plan = folder.plan();
  const SweepOutcome outcome = run_sweep(plan, folder.results(), {.threads = 2});
  EXPECT_EQ(outcome.made, 3);
  EXPECT_EQ(outcome.failed, 0);
  ASSERT_FALSE(outcome.notes.empty());
  EXPECT_THAT(outcome.notes[0], HasSubstr("dopri5"));
}

}  // namespace
}  // namespace loopwright::run_sweep_test
