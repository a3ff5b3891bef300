#include <gtest/gtest.h>
#include <cmath>
#include <numbers>
#include "tests/blocks/block_under_test.h"

namespace loopwright::force_ripple_test {

TEST(ForceRipple, ScalesTheCommandByPosition) {
  BlockUnderTest ripple(
      "ForceRipple",
      R"({"pole_pitch": 0.02, "harmonics": [{"depth": 0.1, "phase": 0.2}, {"order": 2, "depth": 0.05}]})");
  for (double x : {0.0, 0.003, -0.5}) {
    const double angle = 2 * std::numbers::pi * x / 0.02;
    ripple.input("command") = -7, ripple.input("position") = x;
    ripple.evaluate();
    EXPECT_NEAR(ripple.output("force"), -7 * (1 + 0.1 * std::sin(angle + 0.2) + 0.05 * std::sin(2 * angle)),
                1e-12);
  }
}

TEST(ForceRipple, GivesNothingWithoutCommand) {
  BlockUnderTest ripple("ForceRipple", R"({"pole_pitch": 0.02, "harmonics": [{"depth": 0.5}]})");
  ripple.input("position") = 0.005;
  ripple.evaluate();
  EXPECT_EQ(ripple.output("force"), 0.0);
}

}  // namespace loopwright::force_ripple_test
