#include <gmock/gmock.h>
#include <cmath>
#include <vector>
#include "tests/blocks/block_under_test.h"

namespace loopwright::smith_predictor_test {
namespace {

TEST(SmithPredictor, SeesThePlantWithoutItsDeadTimeAndWhatDisturbsIt) {
  // x[k+1] = 0.8 x + 0.5 u, y[k] = x[k-7] + disturbance: the prediction is x[k] + disturbance.
  BlockUnderTest block("SmithPredictor", R"({"numerator": [0, 0.5], "denominator": [1, -0.8], "delay": 7})",
                       0.01);
  ASSERT_FALSE(block.problems().has_errors()) << block.problems().text();
  std::vector<double> x{0};
  for (int k = 0; k < 200; ++k) {
    const double u = std::sin(0.1 * k) + (k > 50), disturbance = k > 120 ? 0.3 : 0;
    block.input("measured") = (k >= 7 ? x[size_t(k) - 7] : 0) + disturbance;
    block.input("command") = 1e6;
    block.evaluate();
    EXPECT_NEAR(block.output("prediction"), x.back() + disturbance, 1e-13) << k;
    block.input("command") = u;
    block.update();
    x.push_back(0.8 * x.back() + 0.5 * u);
  }
}

TEST(SmithPredictor, OfSecondOrderWithALeadingCoefficient) {
  BlockUnderTest block("SmithPredictor",
                       R"({"numerator": [0, 1, 0.4], "denominator": [2, -2.4, 0.8], "delay": 1})", 0.01);
  std::vector<double> m{0, 0}, u{0};
  for (int k = 1; k < 60; ++k) {
    block.evaluate();
    EXPECT_NEAR(block.output("prediction"), m.back() - m[m.size() - 2], 1e-13) << k;
    const double now = std::cos(0.7 * k);
    block.input("command") = now;
    block.update();
    m.push_back((2.4 * m.back() - 0.8 * m[m.size() - 2] + now + 0.4 * u.back()) / 2);
    u.push_back(now);
  }
}

TEST(SmithPredictor, RefusesAModelThatActsAtOnce) {
  EXPECT_THAT(
      BlockUnderTest("SmithPredictor", R"({"numerator": [1, 1], "denominator": [1], "delay": 2})", 0.01)
          .problems()
          .text(),
      testing::HasSubstr("acts at once"));
}

}  // namespace
}  // namespace loopwright::smith_predictor_test
