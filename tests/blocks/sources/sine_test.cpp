#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::sine_test {

TEST(Sine, FollowsTheSineFunction) {
  BlockUnderTest wave("Sine", R"({"amplitude": 2, "frequency": 0.5, "phase": 0.3, "bias": -1})");
  for (double t = 0; t < 10; t += 0.037) {
    wave.evaluate(t);
    EXPECT_NEAR(wave.output("y"), -1 + 2 * std::sin(2 * pi * 0.5 * t + 0.3), 1e-13) << t;
  }
}

TEST(Sine, IsAsExactAfterADayAsAtTheStart) {
  BlockUnderTest wave("Sine", R"({"frequency": 1024})");
  const double quarter = 0.25 / 1024;  // exact in binary
  wave.evaluate(86400 + quarter);
  EXPECT_DOUBLE_EQ(wave.output("y"), 1);
  wave.evaluate(86400);
  EXPECT_EQ(wave.output("y"), 0);
}

TEST(Sine, RefusesANegativeFrequency) {
  EXPECT_TRUE(BlockUnderTest("Sine", R"({"frequency": -1})").problems().has_errors());
}

}  // namespace loopwright::sine_test
