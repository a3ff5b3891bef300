#include <gmock/gmock.h>
#include "tests/blocks/frequency_response.h"

namespace loopwright::discrete_transfer_function_test {
namespace {

TEST(DiscreteTransferFunction, FollowsItsDifferenceEquation) {
  BlockUnderTest block("DiscreteTransferFunction",
                       R"({"numerator": [1, -0.5, 3], "denominator": [2, 0.6, -0.2, 0.1]})", 0.01);
  std::vector<double> u, y;
  for (int k = 0; k < 100; ++k) {
    u.push_back(std::sin(0.37 * k * k));
    const auto past = [&](const std::vector<double>& x, int n) { return k >= n ? x[size_t(k - n)] : 0.0; };
    y.push_back((past(u, 0) - 0.5 * past(u, 1) + 3 * past(u, 2) - 0.6 * past(y, 1) + 0.2 * past(y, 2) -
                 0.1 * past(y, 3)) /
                2);
    EXPECT_NEAR(block.sample("u", u.back(), "y"), y.back(), 1e-13) << k;
  }
}

TEST(DiscreteTransferFunction, AnswersEveryFrequencyAsItsPolynomialsSay) {
  BlockUnderTest block("DiscreteTransferFunction", R"({"numerator": [0, 0.2], "denominator": [1, -0.8]})",
                       0.01);
  for (double w : {0.0, 30.0, 250.0}) {
    const Complex back = std::polar(1.0, -w * 0.01);
    EXPECT_COMPLEX_NEAR(sampled_response(block, "u", "y", w, 0.01, 500), 0.2 * back / (1.0 - 0.8 * back),
                        1e-13);
  }
}

TEST(DiscreteTransferFunction, WithoutPolesIsAFiniteImpulseResponse) {
  BlockUnderTest block("DiscreteTransferFunction", R"({"numerator": [3, 2, 1], "denominator": [1]})", 0.01);
  for (double expected : {3.0, 2.0, 1.0, 0.0, 0.0})
    EXPECT_EQ(block.sample("u", expected == 3 ? 1 : 0, "y"), expected);
}

TEST(DiscreteTransferFunction, OfDegreeZeroIsAFactor) {
  BlockUnderTest block("DiscreteTransferFunction", R"({"numerator": [3], "denominator": [4]})", 0.01);
  for (double u : {4.0, 8.0, -4.0}) EXPECT_EQ(block.sample("u", u, "y"), 0.75 * u);
}

TEST(DiscreteTransferFunction, RefusesEmptyListsAndAMissingOutput) {
  const auto text = [](const char* s) {
    return BlockUnderTest("DiscreteTransferFunction", s, 0.01).problems().text();
  };
  EXPECT_THAT(text(R"({"numerator": [], "denominator": [1]})"), testing::HasSubstr("/numerator"));
  EXPECT_THAT(text(R"({"numerator": [1], "denominator": []})"), testing::HasSubstr("/denominator"));
  EXPECT_THAT(text(R"({"numerator": [1], "denominator": [0, 1]})"),
              testing::HasSubstr("rising powers of 1/z"));
}

}  // namespace
}  // namespace loopwright::discrete_transfer_function_test
