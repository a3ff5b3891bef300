#include <gmock/gmock.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::integrator_test {
namespace {

TEST(Integrator, AddsUpItsInputFromTheInitialValue) {
  BlockUnderTest block("Integrator", R"({"initial": 0.25})");
  block.input("u") = -2;
  block.evaluate();
  block.advance(1.5, 7);
  EXPECT_NEAR(block.state("y"), 0.25 - 3, 1e-15);
  EXPECT_EQ(block.info().outputs[0].group, -1);  // a wire to the state
}

TEST(Integrator, StopsAtALimitAndLeavesItWhenTheInputTurns) {
  BlockUnderTest block("Integrator", R"({"low": -1, "high": 1})");
  block.input("u") = 4;
  block.evaluate();
  block.crossings();
  EXPECT_EQ(block.crossing("high"), -1);  // rises through zero when the limit is reached
  EXPECT_EQ(block.crossing("release"), 1);
  block.state("y") = 1;
  block.evaluate();
  block.derivatives();
  EXPECT_EQ(block.rate("y"), 0);
  block.crossings();
  EXPECT_EQ(block.crossing("release"), 4);
  block.input("u") = -4;
  block.crossings();
  EXPECT_EQ(block.crossing("release"), -4);
  block.evaluate();
  block.derivatives();
  EXPECT_EQ(block.rate("y"), -4);
  block.state("y") = -1;
  block.evaluate();
  block.derivatives();
  EXPECT_EQ(block.rate("y"), 0);
}

TEST(Integrator, AStepThatLeapsOverALimitIsBroughtBack) {
  BlockUnderTest block("Integrator", R"({"high": 1})");
  block.state("y") = 1.3;
  block.evaluate();
  EXPECT_TRUE(block.jump());
  EXPECT_EQ(block.state("y"), 1);
}

TEST(Integrator, IsResetOnceWhenTheTriggerRises) {
  BlockUnderTest block("Integrator", R"({"high": 10})");
  block.state("y") = 5;
  block.input("reset_value") = 2;
  block.input("reset") = -1;
  block.evaluate();
  EXPECT_FALSE(block.jump());
  block.input("reset") = 1;
  block.evaluate();
  EXPECT_TRUE(block.jump());
  EXPECT_EQ(block.state("y"), 2);
  block.state("y") = 3;
  block.evaluate();  // still high: no further edge
  EXPECT_FALSE(block.jump());
  EXPECT_EQ(block.state("y"), 3);
  block.input("reset") = -1;
  block.evaluate();
  block.input("reset") = 1;
  block.input("reset_value") = 99;
  block.evaluate();
  block.jump();
  EXPECT_EQ(block.state("y"), 10);  // the limits apply to the reset value too
}

TEST(Integrator, ATriggerThatIsHighAtTheStartHasNotRisen) {
  BlockUnderTest block("Integrator", R"({"initial": 7})");
  block.input("reset") = 1;
  block.evaluate();
  EXPECT_FALSE(block.jump());
  EXPECT_EQ(block.state("y"), 7);
}

TEST(Integrator, RefusesAnInitialValueOutsideItsLimits) {
  EXPECT_THAT(BlockUnderTest("Integrator", R"({"initial": 3, "high": 2})").problems().text(),
              testing::HasSubstr("/initial"));
  EXPECT_THAT(BlockUnderTest("Integrator", R"({"low": 3, "high": 2})").problems().text(),
              testing::HasSubstr("/low"));
}

}  // namespace
}  // namespace loopwright::integrator_test
