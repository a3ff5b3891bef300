#include <gtest/gtest.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::viscous_friction_test {

TEST(ViscousFriction, IsPositiveForMotionForward) {
  BlockUnderTest block("ViscousFriction", R"({"damping": 3})");
  for (auto [velocity, force] : {std::pair{2.0, 6.0}, {-0.5, -1.5}, {0.0, 0.0}}) {
    block.input("velocity") = velocity;
    block.evaluate();
    EXPECT_NEAR(block.output("force"), force, 1e-12 * std::abs(force)) << velocity;
  }
}

TEST(ViscousFriction, NegativeDampingIsAnError) {
  BlockUnderTest block("ViscousFriction", R"({"damping": -1})");
  EXPECT_TRUE(block.problems().has_errors());
}

}  // namespace loopwright::viscous_friction_test
