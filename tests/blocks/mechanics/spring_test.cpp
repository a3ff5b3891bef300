#include <gtest/gtest.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"

using namespace loopwright;

TEST(Spring, PullsBackToItsRestPosition) {
  BlockUnderTest block("Spring", R"({"stiffness": 40, "rest_position": 0.5})");
  for (auto [position, force] : {std::pair{0.5, 0.0}, {1.0, 20.0}, {0.0, -20.0}}) {
    block.input("position") = position;
    block.evaluate();
    EXPECT_NEAR(block.output("force"), force, 1e-12 * std::abs(force)) << position;
  }
}
