#include <gtest/gtest.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::smooth_coulomb_friction_test {

TEST(SmoothCoulombFriction, FollowsTheHyperbolicTangent) {
  BlockUnderTest block("SmoothCoulombFriction", R"({"level": 0.3, "transition_speed": 0.05})");
  for (auto [velocity, force] :
       {std::pair{0.05, 0.3 * std::tanh(1.0)}, {-0.01, -0.3 * std::tanh(0.2)}, {5.0, 0.3}, {0.0, 0.0}}) {
    block.input("velocity") = velocity;
    block.evaluate();
    EXPECT_NEAR(block.output("force"), force, 1e-12 * std::abs(force)) << velocity;
  }
}

TEST(SmoothCoulombFriction, TransitionSpeedMustBePositive) {
  BlockUnderTest block("SmoothCoulombFriction", R"({"level": 0.3, "transition_speed": 0})");
  EXPECT_TRUE(block.problems().has_errors());
}

}  // namespace loopwright::smooth_coulomb_friction_test
