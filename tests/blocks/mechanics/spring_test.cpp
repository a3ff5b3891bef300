#include <gtest/gtest.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::spring_test {

TEST(Spring, PullsWithItsPreloadAtRest) {
  BlockUnderTest block("Spring", R"({"stiffness": 40, "rest_position": 0.5, "preload": -3})");
  block.input("position") = 0.5;
  block.evaluate();
  EXPECT_EQ(block.output("force"), -3);
}

TEST(Spring, PullsBackToItsRestPosition) {
  BlockUnderTest block("Spring", R"({"stiffness": 40, "rest_position": 0.5})");
  for (auto [position, force] : {std::pair{0.5, 0.0}, {1.0, 20.0}, {0.0, -20.0}}) {
    block.input("position") = position;
    block.evaluate();
    EXPECT_NEAR(block.output("force"), force, 1e-12 * std::abs(force)) << position;
  }
}

}  // namespace loopwright::spring_test
