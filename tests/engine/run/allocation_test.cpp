// A step allocates nothing, with all blocks.
#include <gtest/gtest.h>
#include <cstdlib>
#include <set>
#include "engine/run/recorder.h"
#include "tests/engine/run/examples.h"
#include "tests/engine/solve/allocations.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::allocation_test {
namespace {

using testing::allocations;

int64_t allocations_of_fixed_steps(const Plan& plan, int steps) {
  Run<double> run(plan);
  Recorder recorder(plan);
  const int64_t before = allocations();
  for (int i = 0; i < steps && run.now().tick < plan.stop_tick; ++i)
    run.step_fixed(plan.stop_tick, true, [&] { recorder.record(run); });
  return allocations() - before;
}

/// Between the first and the last call of the progress, which comes every 1024 steps; -1: it came less than
/// twice.
int64_t allocations_of_a_run(const Plan& plan) {
  int64_t first = -1, last = -1;
  RunOptions options;
  options.progress = [&](double, double) { (first < 0 ? first : last) = allocations(); };
  simulate(plan, options);
  return last < 0 ? -1 : last - first;
}

class Allocation : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!testing::allocations_are_counted()) GTEST_SKIP() << "a sanitizer brings its own allocator";
  }
};

TEST_F(Allocation, TheCounterCounts) {
  const int64_t before = allocations();
  void* volatile memory = std::malloc(1);
  std::free(memory);
  EXPECT_GT(allocations(), before);
}

TEST_F(Allocation, NoBlockAllocatesInAFixedStep) {
  std::set<std::string> seen;
  for (const std::string& file : example_files()) {
    Plan plan = *load_plan(file);
    if (!is_fixed_step(plan.method)) plan.method = Method::rk4;
    plan.record_ticks = 1;  // reserves a row for every step
    EXPECT_EQ(allocations_of_fixed_steps(plan, 500), 0) << file;
    for (const Plan::Block& block : plan.blocks) seen.insert(block.type->info.type);
  }
  for (const auto& [name, type] : all_blocks())
    EXPECT_TRUE(seen.contains(name)) << name << " stands in no example";
}

TEST_F(Allocation, NoBlockAllocatesInAVariableStep) {
  for (const std::string& file : example_files()) {
    for (const Method method : {Method::dopri5, Method::cvode_bdf}) {
      Plan plan = *load_plan(file);
      if (plan.states == 0) continue;
      plan.method = method;
      plan.maximum_step = plan.clock.time(plan.stop_tick - plan.start_tick) / 4000;
      EXPECT_EQ(allocations_of_a_run(plan), 0) << to_name(method) << " " << file;
    }
  }
}

TEST_F(Allocation, ARingIsSolvedWithoutAny) {
  const auto plan = plan_of(diagram(
      R"("t": {"type": "Clock"}, "f": {"type": "Expression", "formula": "cos(y)+t", "names": ["y", "t"], "in": {"arguments": ["f.y", "t.time"]}},
    "x": {"type": "Integrator", "in": {"u": "f.y"}})",
      R"("stop": 1, "step": 0.01, "algebraic_loops": "solve")"));
  EXPECT_EQ(allocations_of_fixed_steps(*plan, 100), 0);
}

TEST_F(Allocation, ManyRatesAreScheduledWithoutAny) {
  std::string blocks = R"("t": {"type": "Clock"})";
  for (int i = 1; i <= 12; ++i)
    blocks += fmt::format(
        R"(, "h{}": {{"type": "ZeroOrderHold", "sample_time": "={}/1000", "in": {{"u": "t.time"}}}})", i, i);
  EXPECT_EQ(allocations_of_fixed_steps(*plan_of(diagram(blocks, R"("stop": 1, "step": 0.001)")), 500), 0);
}

TEST_F(Allocation, EventsCostNone) {
  const auto plan = plan_of(diagram(
      R"("x": {"type": "Integrator", "in": {"u": "r.y"}}, "r": {"type": "Relay", "switch_on": 0.2, "switch_off": -0.2, "on": -1, "off": 1, "in": {"u": "x.y"}})",
      R"("stop": 4000, "method": "dopri5", "record_step": 1)"));
  EXPECT_EQ(allocations_of_a_run(*plan), 0);
}

}  // namespace
}  // namespace loopwright::allocation_test
