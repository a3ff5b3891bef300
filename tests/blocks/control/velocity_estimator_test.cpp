#include <gmock/gmock.h>
#include "tests/blocks/frequency_response.h"

namespace loopwright::velocity_estimator_test {
namespace {

constexpr double T = 0.001;

TEST(VelocityEstimator, FilteredIsTheTustinImageOfItsFormula) {
  BlockUnderTest block("VelocityEstimator", R"({"cutoff": 314})", T);
  for (double w : {0.0, 50.0, 314.0, 2500.0}) {
    const Complex s = tustin(w, T);
    EXPECT_COMPLEX_NEAR(sampled_response(block, "position", "velocity", w, T, 1000), 314.0 * s / (s + 314.0),
                        1e-10);
  }
}

TEST(VelocityEstimator, BackwardDifferenceIsTheMeanVelocityOfItsWindow) {
  for (int n : {1, 4}) {
    BlockUnderTest block("VelocityEstimator",
                         R"({"method": "backward_difference", "samples": )" + std::to_string(n) + "}", T);
    for (int k = 0; k < 30; ++k) {
      const double x = 1e-4 * k * k, before = k < n ? 0 : 1e-4 * (k - n) * (k - n);
      EXPECT_NEAR(block.sample("position", x, "velocity"), (x - before) / (n * T), 1e-11);
    }
  }
}

TEST(VelocityEstimator, BothFindASteadyVelocityAndStartAtRest) {
  for (const char* method : {R"("cutoff": 314)", R"("method": "backward_difference", "samples": 3)"}) {
    BlockUnderTest block("VelocityEstimator", R"({"initial": 5, )" + std::string(method) + "}", T);
    EXPECT_EQ(block.sample("position", 5, "velocity"), 0);
    for (int k = 1; k < 400; ++k) block.sample("position", 5 - 0.3 * T * k, "velocity");
    EXPECT_NEAR(block.output("velocity"), -0.3, 1e-11);
  }
}

TEST(VelocityEstimator, RefusesWhatItsMethodDoesNotUse) {
  EXPECT_THAT(BlockUnderTest("VelocityEstimator", "{}", T).problems().text(),
              testing::HasSubstr("needs a bandwidth"));
  EXPECT_THAT(BlockUnderTest("VelocityEstimator", R"({"cutoff": 9, "samples": 2})", T).problems().text(),
              testing::HasSubstr("/samples"));
}

}  // namespace
}  // namespace loopwright::velocity_estimator_test
