#include <gtest/gtest.h>
#include <cmath>
#include <numbers>
#include "tests/blocks/block_under_test.h"

namespace loopwright::encoder_test {

namespace {
double read(BlockUnderTest& encoder, double position) {
  encoder.input("position") = position;
  encoder.evaluate();
  return encoder.output("position");
}
}  // namespace

TEST(Encoder, RoundsToCountsHalfToEven) {
  BlockUnderTest encoder("Encoder", R"({"resolution": 0.25})");
  const double pairs[][2] = {{0.1, 0.0},   {0.125, 0.0},  {0.2, 0.25},
                             {0.375, 0.5}, {-0.125, 0.0}, {-0.3, -0.25}};
  for (auto [position, measured] : pairs) EXPECT_EQ(read(encoder, position), measured) << position;
}

TEST(Encoder, PeriodicErrorAndOffsetComeBeforeCounting) {
  BlockUnderTest encoder("Encoder", R"({"resolution": 1e-7, "offset": 3e-3, "pitch": 4e-3,
      "periodic_error": [{"amplitude": 2e-6, "phase": 0.5}, {"order": 2, "amplitude": 1e-6}]})");
  for (double x : {0.0, 0.0011, -0.7}) {
    const double angle = 2 * std::numbers::pi * x / 4e-3;
    const double seen = x + 3e-3 + 2e-6 * std::sin(angle + 0.5) + 1e-6 * std::sin(2 * angle);
    EXPECT_NEAR(read(encoder, x), seen, 0.5e-7 * (1 + 1e-9));
    EXPECT_NEAR(std::remainder(read(encoder, x), 1e-7), 0, 1e-15);
  }
}

TEST(Encoder, WithoutResolutionItDoesNotCount) {
  BlockUnderTest encoder("Encoder", R"({"resolution": 0, "offset": 0.5})");
  EXPECT_EQ(read(encoder, 0.1234567), 0.6234567);
}

TEST(Encoder, ACountIsHeldUntilTheCrossingSaysSo) {
  BlockUnderTest encoder("Encoder", R"({"resolution": 1})");
  read(encoder, 0.4);
  encoder.input("position") = 0.49;
  encoder.crossings();
  EXPECT_GT(encoder.crossing("count"), 0);
  encoder.input("position") = 0.51;
  encoder.crossings();
  EXPECT_LT(encoder.crossing("count"), 0);
  encoder.evaluate_held(0);
  EXPECT_EQ(encoder.output("position"), 0.0);
  EXPECT_EQ(read(encoder, 0.51), 1.0);
}

TEST(Encoder, PeriodicErrorNeedsAPitch) {
  BlockUnderTest encoder("Encoder", R"({"resolution": 1e-7, "periodic_error": [{"amplitude": 1e-6}]})");
  ASSERT_TRUE(encoder.problems().has_errors());
  EXPECT_NE(encoder.problems().text().find("pitch"), std::string::npos);
}

}  // namespace loopwright::encoder_test
