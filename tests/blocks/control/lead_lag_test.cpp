#include <gtest/gtest.h>
#include "tests/blocks/frequency_response.h"

namespace loopwright::lead_lag_test {
namespace {

TEST(LeadLag, IsTheTustinImageOfItsFormula) {
  const double T = 0.001;
  for (double zero : {20.0, 900.0}) {
    BlockUnderTest block("LeadLag", R"({"gain": 3, "pole": 200, "zero": )" + std::to_string(zero) + "}", T);
    for (double w : {0.0, 20.0, 200.0, 2500.0}) {
      const Complex s = tustin(w, T);
      EXPECT_COMPLEX_NEAR(sampled_response(block, "u", "y", w, T, 2000),
                          3.0 * (1.0 + s / zero) / (1.0 + s / 200.0), 1e-11);
    }
  }
}

TEST(LeadLag, ItsGainAtRestIsTheGain) {
  BlockUnderTest block("LeadLag", R"({"gain": 3, "pole": 200, "zero": 20})", 0.001);
  for (int k = 0; k < 500; ++k) block.sample("u", 2, "y");
  EXPECT_NEAR(block.output("y"), 6, 1e-13);
}

TEST(LeadLag, StartsAtRestWithItsInput) {
  BlockUnderTest block("LeadLag", R"({"gain": 3, "pole": 200, "zero": 20, "initial": 2})", 0.001);
  for (int k = 0; k < 10; ++k) EXPECT_NEAR(block.sample("u", 2, "y"), 6, 1e-13) << k;
}

TEST(ContinuousLeadLag, HasItsTransferFunction) {
  BlockUnderTest block("ContinuousLeadLag", R"({"gain": 2, "zero": 20, "pole": 80})");
  for (double w : {0.0, 5.0, 40.0, 300.0}) {
    const Complex s(0, w);
    EXPECT_COMPLEX_NEAR(continuous_response(block, "u", "y", w), 2.0 * (1.0 + s / 20.0) / (1.0 + s / 80.0),
                        1e-12);
  }
}

TEST(ContinuousLeadLag, StartsAtRestWithItsInput) {
  BlockUnderTest block("ContinuousLeadLag", R"({"gain": 2, "zero": 20, "pole": 80, "initial": 3})");
  block.input("u") = 3;
  block.evaluate();
  block.derivatives();
  EXPECT_EQ(block.output("y"), 6);
  EXPECT_EQ(block.rates()[0], 0);
}

}  // namespace
}  // namespace loopwright::lead_lag_test
