#include <gtest/gtest.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::quadratic_drag_test {

TEST(QuadraticDrag, GrowsWithTheSquareOfSpeedAndKeepsItsSign) {
  BlockUnderTest block("QuadraticDrag", R"({"drag": 0.3})");
  for (auto [velocity, force] : {std::pair{2.0, 1.2}, {-2.0, -1.2}, {0.0, 0.0}}) {
    block.input("velocity") = velocity;
    block.evaluate();
    EXPECT_NEAR(block.output("force"), force, 1e-12 * std::abs(force)) << velocity;
  }
}

}  // namespace loopwright::quadratic_drag_test
