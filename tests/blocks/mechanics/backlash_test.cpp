#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::backlash_test {

TEST(Backlash, OutputWaitsUntilTheGapIsCrossed) {
  BlockUnderTest play("Backlash", R"({"gap": 2})");
  const double path[][2] = {{0, 0}, {0.9, 0}, {3, 2}, {1.5, 2}, {1, 2}, {0, 1}, {0.5, 1}, {2, 1}, {2.5, 1.5}};
  for (auto [u, y] : path) {
    play.input("u") = u;
    play.evaluate();
    EXPECT_DOUBLE_EQ(play.output("y"), y) << u;
  }
}

TEST(Backlash, IsRateIndependent) {
  BlockUnderTest coarse("Backlash", R"({"gap": 0.3})"), fine("Backlash", R"({"gap": 0.3})");
  const double turns[] = {0, 1, -0.5, 0.2, 0.1, 0.8};
  for (size_t i = 1; i < std::size(turns); ++i) {
    for (int k = 1; k <= 100; ++k) {
      fine.input("u") = turns[i - 1] + (turns[i] - turns[i - 1]) * k / 100;
      fine.evaluate();
    }
    coarse.input("u") = turns[i];
    coarse.evaluate();
    EXPECT_NEAR(coarse.output("y"), fine.output("y"), 1e-14);
  }
}

TEST(Backlash, WithoutAGapItIsAWire) {
  BlockUnderTest play("Backlash", R"({"gap": 0, "initial": 4})");
  for (double u : {1.0, -2.0, 0.5}) {
    play.input("u") = u;
    play.evaluate();
    EXPECT_EQ(play.output("y"), u);
  }
}

TEST(Backlash, StartsAtItsInitialOutputWhereTheInputAllows) {
  BlockUnderTest play("Backlash", R"({"gap": 2, "initial": 0.5})");
  play.input("u") = 0;
  play.evaluate();
  EXPECT_EQ(play.output("y"), 0.5);
}

}  // namespace loopwright::backlash_test
