#include <gtest/gtest.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::hardening_spring_test {

TEST(HardeningSpring, StiffensWithDeflection) {
  BlockUnderTest block("HardeningSpring",
                       R"({"stiffness": 40, "cubic_stiffness": 1000, "rest_position": 0.5})");
  for (auto [position, force] : {std::pair{0.5, 0.0},
                                 {0.75, 40 * 0.25 + 1000 * 0.25 * 0.25 * 0.25},
                                 {0.25, -40 * 0.25 - 1000 * 0.25 * 0.25 * 0.25}}) {
    block.input("position") = position;
    block.evaluate();
    EXPECT_NEAR(block.output("force"), force, 1e-12 * std::abs(force)) << position;
  }
}

}  // namespace loopwright::hardening_spring_test
