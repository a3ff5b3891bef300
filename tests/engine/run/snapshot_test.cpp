// The arena contains the whole run: restored, it repeats the same bits. Two equal runs have the same bits.
#include <gtest/gtest.h>
#include <cstring>
#include <fstream>
#include <sstream>
#include "engine/record/csv.h"
#include "engine/run/recorder.h"
#include "tests/engine/run/examples.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::snapshot_test {
namespace {

using ScalarRun = Run<double>;  // the name Run is taken inside a test

/// Every number of the arena after each of several steps.
std::vector<std::string> steps(ScalarRun& run, int count) {
  std::vector<std::string> arenas;
  const Plan& plan = run.plan();
  for (int i = 0; i < count && run.now().tick < plan.stop_tick; ++i) {
    run.step_fixed(plan.stop_tick, true, [] {});
    arenas.emplace_back(run.arena().data(), run.arena().size());
  }
  return arenas;
}

TEST(Snapshot, OfTheArenaRestoresEveryBlockBitByBit) {
  for (const std::string& file : example_files()) {
    Plan plan = *load_plan(file);
    if (!is_fixed_step(plan.method)) plan.method = Method::rk4;
    ScalarRun run(plan);
    steps(run, 30);
    const std::string arena(run.arena().data(), run.arena().size());
    const int64_t tick = run.now().tick;
    const auto first = steps(run, 30);
    std::memcpy(run.arena().data(), arena.data(), arena.size());
    run.restored({plan.clock.time(tick), tick});
    EXPECT_TRUE(steps(run, 30) == first) << file;
  }
}

TEST(Snapshot, GoesOnInAnotherRunOfTheSamePlan) {
  for (const std::string& file : example_files()) {
    Plan plan = *load_plan(file);
    if (!is_fixed_step(plan.method)) plan.method = Method::rk4;
    ScalarRun one(plan), other(plan);
    steps(one, 30);
    std::memcpy(other.arena().data(), one.arena().data(), one.arena().size());
    other.restored(one.now());
    EXPECT_TRUE(steps(other, 30) == steps(one, 30))
        << file << ": something mutable lies outside of the arena";
  }
}

TEST(Snapshot, ResetBeginsAnew) {
  for (const std::string& file : example_files()) {
    Plan plan = *load_plan(file);
    if (!is_fixed_step(plan.method)) plan.method = Method::rk4;
    ScalarRun run(plan);
    const auto first = steps(run, 40);
    run.reset({plan.seed, 0});
    EXPECT_TRUE(steps(run, 40) == first) << file;
  }
}

std::string csv_bytes(const RunResult& result) {
  DiagramFolder folder;
  write_csv(folder.path("run.csv"), result.recording);
  std::ifstream file(folder.path("run.csv"), std::ios::binary);
  std::stringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

constexpr std::string_view noisy =
    R"("n": {"type": "Noise", "sample_time": 0.01, "standard_deviation": 1}, "x": {"type": "LowPass", "cutoff": 20, "in": {"u": "n.y"}},
  "r": {"type": "Relay", "switch_on": 0.05, "switch_off": -0.05, "in": {"u": "x.y"}}, "y": {"type": "Integrator", "in": {"u": "r.y"}})";

TEST(Repeat, TwoRunsWriteTheSameBytes) {
  for (const char* solver :
       {R"("stop": 1, "step": 0.001)", R"("stop": 1, "method": "dopri5")",
        R"("stop": 1, "method": "cvode-bdf")", R"("stop": 1, "method": "cvode-adams")"}) {
    const std::string bytes = csv_bytes(run_of(diagram(noisy, solver)));
    EXPECT_GT(bytes.size(), 1000u);
    EXPECT_EQ(bytes, csv_bytes(run_of(diagram(noisy, solver)))) << solver;
  }
}

TEST(Repeat, AnotherSeedOrRunNumberIsOtherNoise) {
  const auto noise = [](std::string_view solver, int64_t run) {
    RunOptions options;
    options.run = run;
    return signal(run_of(diagram(noisy, solver), options), "n.y");
  };
  const auto base = noise(R"("stop": 1, "step": 0.001)", 0);
  EXPECT_NE(base, noise(R"("stop": 1, "step": 0.001, "seed": 2)", 0));
  EXPECT_NE(base, noise(R"("stop": 1, "step": 0.001)", 1));
  EXPECT_EQ(base, noise(R"("stop": 1, "step": 0.002)", 0)) << "and the step of the solver does not matter";
}

}  // namespace
}  // namespace loopwright::snapshot_test
