#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::quantizer_test {

TEST(Quantizer, RoundsToTheNearestMultipleAndHalvesToEven) {
  BlockUnderTest quantizer("Quantizer", R"({"resolution": 0.5})");
  const double u[] = {0.2, 0.25, 0.3, 0.75, -0.25, -0.26, 7.49}, expected[] = {0, 0, 0.5, 1, 0, -0.5, 7.5};
  for (int i = 0; i < 7; ++i) {
    quantizer.input("u") = u[i];
    quantizer.evaluate();
    EXPECT_EQ(quantizer.output("y"), expected[i]) << u[i];
  }
}

TEST(Quantizer, IsNeverFurtherOffThanHalfAStep) {
  const double resolution = 2e-7;
  BlockUnderTest quantizer("Quantizer", R"({"resolution": 2e-7})");
  for (double u = -0.001; u < 0.001; u += 1.2345e-8) {
    quantizer.input("u") = u;
    quantizer.evaluate();
    const double y = quantizer.output("y");
    ASSERT_LE(std::abs(y - u), 0.5 * resolution * (1 + 1e-12)) << u;
    ASSERT_NEAR(y / resolution, std::round(y / resolution), 1e-9) << u;
  }
}

TEST(Quantizer, HoldsItsStepUntilACrossing) {
  BlockUnderTest quantizer("Quantizer", R"({"resolution": 1})");
  quantizer.input("u") = 2.4;
  quantizer.evaluate();
  quantizer.input("u") = 2.6;
  quantizer.evaluate_held(0.1);
  EXPECT_EQ(quantizer.output("y"), 2);
  quantizer.crossings();
  EXPECT_GT(quantizer.crossing("upper"), 0);
  EXPECT_GT(quantizer.crossing("lower"), 0);
  quantizer.input("u") = 1.4;
  quantizer.crossings();
  EXPECT_LT(quantizer.crossing("upper"), 0);
  EXPECT_LT(quantizer.crossing("lower"), 0);
}

/// 2.5 rounds to 2: values just above must still appear as a change of sign.
TEST(Quantizer, ASignalThatStartsOnAnEdgeIsNotOnZero) {
  BlockUnderTest quantizer("Quantizer", R"({"resolution": 1})");
  quantizer.input("u") = 2.5;
  quantizer.evaluate();
  quantizer.crossings();
  EXPECT_LT(quantizer.crossing("upper"), 0);
}

TEST(Quantizer, RefusesAResolutionOfZero) {
  EXPECT_TRUE(BlockUnderTest("Quantizer", R"({"resolution": 0})").problems().has_errors());
}

}  // namespace loopwright::quantizer_test
