#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::fractional_delay_test {

TEST(FractionalDelay, HoldsTheMeanOfTheLateStaircase) {
  BlockUnderTest late("FractionalDelay", R"({"delay": 0.0225, "initial": -1})", 0.01);
  const double given[] = {1, 2, 4, 8, 16},
               expected[] = {-1, -1, 0.75 * 1 - 0.25 * 1, 0.75 * 2 + 0.25 * 1, 0.75 * 4 + 0.25 * 2};
  for (size_t k = 0; k < std::size(given); ++k)
    EXPECT_NEAR(late.sample("u", given[k], "y"), expected[k], 1e-12) << k;
}

TEST(FractionalDelay, TheSlopeHasTheFirstMomentOfTheLateStaircase) {
  BlockUnderTest late("FractionalDelay", R"({"delay": 0.0225})", 0.01);
  double given[] = {1, 2, 4, 8, 16}, from = 0;
  for (size_t k = 0; k < std::size(given); ++k) {
    late.sample("u", given[k], "y");
    const double to = k < 2 ? 0 : given[k - 2];
    double moment = 0;  // ∫ (t - ½) u dt, with a change at a quarter of the sample
    constexpr int parts = 100000;
    for (int i = 0; i < parts; ++i) {
      const double t = (i + 0.5) / parts;
      moment += (t - 0.5) * (t < 0.25 ? from : to) / parts;
    }
    EXPECT_NEAR(late.output("slope"), 12 * moment, 1e-8) << k;  // slope · (t - ½) has slope / 12
    from = to;
  }
}

TEST(FractionalDelay, WithoutDelayItIsAWire) {
  BlockUnderTest late("FractionalDelay", R"({"delay": 0})", 0.01);
  for (double u : {3.0, -1.0, 2.0}) EXPECT_EQ(late.sample("u", u, "y"), u);
}

TEST(FractionalDelay, WholeSamplesAreThoseOfADelay) {
  BlockUnderTest late("FractionalDelay", R"({"delay": 0.03, "samples": 3})", 0.01),
      whole("Delay", R"({"samples": 3})", 0.01);
  for (int k = 0; k < 12; ++k) EXPECT_EQ(late.sample("u", k * k, "y"), whole.sample("u", k * k, "y")) << k;
  EXPECT_EQ(late.fault(), "");
}

TEST(FractionalDelay, WholeSamplesOfAnyPeriodAreThose) {
  for (const int rate : {700, 1000, 3000, 9999})
    for (int samples = 1; samples < 60; ++samples) {
      const double delay = double(samples) / rate;
      BlockUnderTest late("FractionalDelay",
                          R"({"samples": 100, "delay": )" + reading::number_text(delay) + "}", 1.0 / rate);
      for (int k = 0; k <= samples + 3; ++k)
        ASSERT_EQ(late.sample("u", k + 1, "y"), k < samples ? 0 : k - samples + 1) << samples << "/" << rate;
      EXPECT_EQ(late.output("slope"), 0);
    }
}

TEST(FractionalDelay, RefusesADelayThatItHasNoRoomFor) {
  BlockUnderTest late("FractionalDelay", R"({"delay": 0.05, "samples": 3})", 0.01);
  late.sample("u", 1, "y");
  EXPECT_NE(late.fault(), "");
}

}  // namespace loopwright::fractional_delay_test
