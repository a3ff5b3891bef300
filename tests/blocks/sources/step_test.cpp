#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::step_test {

TEST(Step, JumpsAtItsTimeAndNotBefore) {
  BlockUnderTest step("Step", R"({"time": 0.5, "before": -1, "after": 3})");
  step.evaluate(0.49999);
  EXPECT_EQ(step.output("y"), -1);
  step.evaluate(0.5);
  EXPECT_EQ(step.output("y"), 3);
  step.evaluate(100);
  EXPECT_EQ(step.output("y"), 3);
}

TEST(Step, HoldsItsValueInsideASolverStep) {
  BlockUnderTest step("Step", R"({"time": 0.5})");
  step.evaluate(0.4);
  step.evaluate_held(0.6);
  EXPECT_EQ(step.output("y"), 0);
}

TEST(Step, JumpsAtTheTimeThatWasMeant) {
  BlockUnderTest step("Step",
                      R"({"time": 0.00030000000000000003})");  // 3 * 0.0001, as an expression gives it
  step.evaluate(0.0003);
  EXPECT_EQ(step.output("y"), 1);
  EXPECT_EQ(step.next_stop(0), 0.0003);
}

TEST(Step, TellsTheSolverWhereItJumps) {
  BlockUnderTest step("Step", R"({"time": 0.5})");
  EXPECT_EQ(step.next_stop(0), 0.5);
  EXPECT_EQ(step.next_stop(0.5), infinity);
}

}  // namespace loopwright::step_test
