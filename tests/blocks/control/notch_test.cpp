#include <gmock/gmock.h>
#include "tests/blocks/frequency_response.h"

namespace loopwright::notch_test {
namespace {

constexpr double T = 0.001;

TEST(Notch, HasTheContinuousFormulaAtWarpedFrequencies) {
  const double center = 600;
  BlockUnderTest block("Notch", R"({"frequency": 600, "depth_damping": 0.05, "width_damping": 0.4})", T);
  for (double w : {0.0, 100.0, 550.0, 600.0, 700.0, 3000.0}) {
    const Complex p(0, std::tan(w * T / 2) / std::tan(center * T / 2));
    EXPECT_COMPLEX_NEAR(sampled_response(block, "u", "y", w, T, 3000),
                        (p * p + 0.1 * p + 1.0) / (p * p + 0.8 * p + 1.0), 1e-11);
  }
}

TEST(Notch, TakesItsFrequencyOutAndLeavesRestAlone) {
  BlockUnderTest block("Notch", R"({"frequency": 600, "width_damping": 0.4})", T);
  EXPECT_COMPLEX_NEAR(sampled_response(block, "u", "y", 600, T, 3000), 0, 1e-12);
  EXPECT_COMPLEX_NEAR(sampled_response(block, "u", "y", 0, T, 3000), 1, 1e-12);
}

TEST(Notch, FaultsFromHalfTheSamplingFrequencyOn) {
  BlockUnderTest block("Notch", R"({"frequency": 3000, "width_damping": 0.4})", T);
  block.evaluate();
  EXPECT_EQ(block.fault(), "");
  block.tune("frequency", 3142);
  block.evaluate();
  EXPECT_THAT(std::string(block.fault()), testing::HasSubstr("half the sampling frequency"));
}

TEST(Notch, StartsAtRestWithItsInput) {
  BlockUnderTest block("Notch",
                       R"({"frequency": 600, "depth_damping": 0.05, "width_damping": 0.4, "initial": 3})", T);
  for (int k = 0; k < 10; ++k) EXPECT_NEAR(block.sample("u", 3, "y"), 3, 1e-14) << k;
}

TEST(ContinuousNotch, HasItsTransferFunction) {
  BlockUnderTest block("ContinuousNotch",
                       R"({"frequency": 600, "depth_damping": 0.05, "width_damping": 0.4})");
  for (double w : {0.0, 100.0, 550.0, 600.0, 700.0, 3000.0}) {
    const Complex p(0, w / 600);
    EXPECT_COMPLEX_NEAR(continuous_response(block, "u", "y", w),
                        (p * p + 0.1 * p + 1.0) / (p * p + 0.8 * p + 1.0), 1e-12);
  }
}

TEST(ContinuousNotch, StartsAtRestWithItsInput) {
  BlockUnderTest block("ContinuousNotch", R"({"frequency": 600, "width_damping": 0.4, "initial": 3})");
  block.input("u") = 3;
  block.evaluate();
  block.derivatives();
  EXPECT_EQ(block.output("y"), 3);
  EXPECT_THAT(block.rates(), testing::ElementsAre(0, 0));
}

}  // namespace
}  // namespace loopwright::notch_test
