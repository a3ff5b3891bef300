#include <gtest/gtest.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::eddy_current_drag_test {

TEST(EddyCurrentDrag, IsViscousAtFirstAndPeaksAtTheCriticalSpeed) {
  BlockUnderTest block("EddyCurrentDrag", R"({"damping": 4, "critical_speed": 0.5})");
  for (auto [velocity, force] : {std::pair{1e-9, 4e-9}, {0.5, 1.0}, {1.0, 4 / 5.0}, {-0.5, -1.0}}) {
    block.input("velocity") = velocity;
    block.evaluate();
    EXPECT_NEAR(block.output("force"), force, 1e-12 * std::abs(force)) << velocity;
  }
}

}  // namespace loopwright::eddy_current_drag_test
