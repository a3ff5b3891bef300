#include <gmock/gmock.h>
#include "tests/blocks/frequency_response.h"

namespace loopwright::low_pass_test {
namespace {

std::string settings(int order, const char* shape) {
  return R"({"cutoff": 20, "order": )" + std::to_string(order) + R"(, "shape": ")" + shape + R"("})";
}

TEST(LowPass, ButterworthIsFlatAndPassesHalfThePowerAtTheCutoff) {
  for (int order : {1, 2, 3, 4, 5, 8, 13}) {
    BlockUnderTest block("LowPass", settings(order, "butterworth"));
    for (double w : {0.0, 5.0, 20.0, 31.0}) {
      const double power = std::norm(continuous_response(block, "u", "y", w));
      EXPECT_NEAR(power, 1 / (1 + std::pow(w / 20, 2 * order)), 1e-12) << "order " << order << " at " << w;
    }
  }
}

TEST(LowPass, ButterworthOfThirdOrderHasTheTextbookPolynomial) {
  BlockUnderTest block("LowPass", settings(3, "butterworth"));
  for (double w : {1.0, 20.0, 60.0}) {
    const Complex p(0, w / 20);
    EXPECT_COMPLEX_NEAR(continuous_response(block, "u", "y", w),
                        1.0 / (p * p * p + 2.0 * p * p + 2.0 * p + 1.0), 1e-13);
  }
}

TEST(LowPass, CriticallyDampedIsAChainOfEqualLags) {
  for (int order : {1, 2, 3, 6}) {
    BlockUnderTest block("LowPass", settings(order, "critically_damped"));
    for (double w : {0.0, 10.0, 70.0})
      EXPECT_COMPLEX_NEAR(continuous_response(block, "u", "y", w), std::pow(20.0 / Complex(20, w), order),
                          1e-13);
  }
}

TEST(LowPass, CriticallyDampedStepHasTheClosedFormAndNeverOvershoots) {
  BlockUnderTest block("LowPass", settings(2, "critically_damped"));
  block.input("u") = 1;
  double greatest = 0;
  for (int i = 1; i <= 100; ++i) {
    block.advance(0.01, 50);
    block.evaluate();
    const double turn = 20 * 0.01 * i;
    EXPECT_NEAR(block.output("y"), 1 - (1 + turn) * std::exp(-turn), 1e-9);
    greatest = std::max(greatest, block.output("y"));
  }
  EXPECT_LE(greatest, 1);
}

TEST(LowPass, StaysAtRestAtItsInitialValue) {
  for (int order : {1, 2, 5}) {
    BlockUnderTest block("LowPass",
                         R"({"cutoff": 20, "initial": 0.7, "order": )" + std::to_string(order) + "}");
    block.input("u") = 0.7;
    block.advance(1, 100);
    block.evaluate();
    EXPECT_EQ(block.output("y"), 0.7);
  }
}

TEST(LowPass, RefusesOrderZero) {
  EXPECT_THAT(BlockUnderTest("LowPass", R"({"cutoff": 20, "order": 0})").problems().text(),
              testing::HasSubstr("at least 1"));
  EXPECT_THAT(BlockUnderTest("LowPass", R"({"cutoff": 0})").problems().text(), testing::HasSubstr("above 0"));
}

}  // namespace
}  // namespace loopwright::low_pass_test
