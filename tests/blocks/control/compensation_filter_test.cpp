#include <gmock/gmock.h>
#include "tests/blocks/frequency_response.h"

namespace loopwright::compensation_filter_test {
namespace {

constexpr double T = 0.001;

TEST(CompensationFilter, IsALagThatStartsOneSampleLate) {
  BlockUnderTest block("CompensationFilter", R"({"cutoff": 600, "weight": 0.95})", T);
  const double a = std::exp(-0.6);
  for (double w : {0.0, 100.0, 2000.0}) {
    const Complex back = std::polar(1.0, -w * T);
    EXPECT_COMPLEX_NEAR(sampled_response(block, "prediction", "compensation", w, T, 200),
                        0.95 * (1 - a) * back / (1.0 - a * back), 1e-13);
  }
}

TEST(CompensationFilter, BringsItsWeightInAlongARamp) {
  BlockUnderTest block("CompensationFilter",
                       R"({"cutoff": 600, "weight": 0.8, "start_time": 0.02, "ramp_time": 0.1})", T);
  const double a = std::exp(-0.6);
  double expected = 0;
  for (int k = 0; k < 200; ++k) {
    EXPECT_NEAR(block.sample("prediction", 2, "compensation"), expected, 1e-14) << k;
    expected = a * expected + (1 - a) * 0.8 * std::clamp((k * T - 0.02) / 0.1, 0.0, 1.0) * 2;
  }
  EXPECT_NEAR(expected, 1.6, 1e-12);
}

TEST(CompensationFilter, WithoutARampBeginsAtOnce) {
  BlockUnderTest block("CompensationFilter", R"({"cutoff": 600, "start_time": 0.003})", T);
  for (int k = 0; k < 3; ++k) block.sample("prediction", 1, "compensation");
  EXPECT_EQ(block.sample("prediction", 1, "compensation"), 0);
  EXPECT_GT(block.sample("prediction", 1, "compensation"), 0.4);
}

TEST(CompensationFilter, NeedsNoPresentInput) {
  EXPECT_EQ(BlockUnderTest("CompensationFilter", R"({"cutoff": 600})", T).info().outputs[0].fed_by, 0u);
}

}  // namespace
}  // namespace loopwright::compensation_filter_test
