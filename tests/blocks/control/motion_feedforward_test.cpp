#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::motion_feedforward_test {
namespace {

TEST(MotionFeedforward, IsWhatTheNominalMassNeeds) {
  BlockUnderTest block("MotionFeedforward", R"({"mass": 2, "damping": 3})");
  block.input("velocity") = 0.5, block.input("acceleration") = -4;
  block.evaluate();
  EXPECT_EQ(block.output("command"), 2 * -4 + 3 * 0.5);
}

TEST(MotionFeedforward, OvercomesCoulombFrictionInTheDirectionOfMotion) {
  BlockUnderTest block("MotionFeedforward", R"({"mass": 0, "damping": 0, "coulomb": 0.7})");
  for (double v : {0.2, 0.0, -0.2}) {
    block.input("velocity") = v;
    block.evaluate();
    EXPECT_EQ(block.output("command"), v > 0 ? 0.7 : v < 0 ? -0.7 : 0);
  }
}

TEST(MotionFeedforward, HoldsTheDirectionInsideAStepAndCrossesWhereItChanges) {
  BlockUnderTest block("MotionFeedforward", R"({"mass": 0, "damping": 0, "coulomb": 0.7})");
  block.input("velocity") = 0.2;
  block.evaluate();
  block.input("velocity") = -0.1;
  block.evaluate_held(0.1);
  EXPECT_EQ(block.output("command"), 0.7);
  block.crossings();
  EXPECT_LT(block.crossing("forwards"), 0);
  EXPECT_LT(block.crossing("backwards"), 0);
  block.input("velocity") = 0;  // at rest there is no direction, so that leaving rest changes a sign
  block.crossings();
  EXPECT_LT(block.crossing("forwards"), 0);
  EXPECT_GT(block.crossing("backwards"), 0);
}

}  // namespace
}  // namespace loopwright::motion_feedforward_test
