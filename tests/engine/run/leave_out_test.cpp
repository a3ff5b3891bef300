#include <gtest/gtest.h>
#include "engine/run/run.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::leave_out_test {
namespace {

TEST(LeaveOut, WhatReadsABlockThatIsLeftOutReadsTheValueOfItsOutput) {
  const auto plan = plan_of(diagram(
      R"("x": {"type": "Integrator", "initial": 3, "in": {"u": "minus.y"}},
         "minus": {"type": "Gain", "gain": -2, "in": {"u": "x.y"}})",
      R"("stop": 1, "step": 0.1)"));
  ASSERT_TRUE(plan);
  loopwright::Run<double> run(*plan);
  const auto block = std::ranges::find(plan->blocks, "minus", &Plan::Block::path);
  std::vector<bool> blocks(plan->blocks.size(), false);
  const double x = 5;
  double rate = 0;
  EXPECT_TRUE(run.derivatives_at(0, &x, &rate));
  EXPECT_EQ(rate, -10);
  blocks[size_t(block - plan->blocks.begin())] = true;
  run.leave_out(blocks);
  reinterpret_cast<double*>(run.arena().data())[block->outputs[0]] = 7;
  EXPECT_TRUE(run.derivatives_at(0, &x, &rate));
  EXPECT_EQ(rate, 7);
  run.evaluate(0, false);
  EXPECT_EQ(run.number(block->outputs[0]), 7);
  run.leave_out(std::vector<bool>(plan->blocks.size(), false));
  EXPECT_TRUE(run.derivatives_at(0, &x, &rate));
  EXPECT_EQ(rate, -10);
}

}  // namespace
}  // namespace loopwright::leave_out_test
