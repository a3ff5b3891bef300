#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::noise_test {

namespace {

std::vector<double> numbers(std::string_view settings, Setup setup, int count) {
  setup.sample_time = 0.001;
  BlockUnderTest noise("Noise", settings, setup);
  std::vector<double> y;
  for (int i = 0; i < count; ++i) {
    noise.evaluate(0.001 * i, i);
    y.push_back(noise.output("y"));
    noise.update();
  }
  return y;
}
double mean_of(const std::vector<double>& y, auto f) {
  double sum = 0;
  for (double x : y) sum += f(x);
  return sum / double(y.size());
}
double correlation(const std::vector<double>& a, const std::vector<double>& b, size_t shift) {
  double sum = 0;
  for (size_t i = 0; i + shift < a.size(); ++i) sum += a[i] * b[i + shift];
  return sum / double(a.size() - shift);
}

}  // namespace

// Bounds are five standard errors of the mean over the 200,000 numbers.
TEST(Noise, NormalNumbersHaveTheMomentsOfTheNormalDistribution) {
  const auto y = numbers(R"({"standard_deviation": 1})", {0, 1, 0, 99}, 200000);
  EXPECT_NEAR(mean_of(y, [](double x) { return x; }), 0, 5 * std::sqrt(1 / 2e5));
  EXPECT_NEAR(mean_of(y, [](double x) { return x * x; }), 1, 5 * std::sqrt(2 / 2e5));
  EXPECT_NEAR(mean_of(y, [](double x) { return x * x * x; }), 0, 5 * std::sqrt(15 / 2e5));
  EXPECT_NEAR(mean_of(y, [](double x) { return x * x * x * x; }), 3, 5 * std::sqrt(96 / 2e5));
  for (double z : {-2.0, -1.0, 0.5, 1.5}) {
    const double p = 0.5 * std::erfc(-z / std::numbers::sqrt2);
    EXPECT_NEAR(mean_of(y, [z](double x) { return x < z; }), p, 5 * std::sqrt(p * (1 - p) / 2e5)) << z;
  }
}

TEST(Noise, UniformNumbersHaveTheAskedDeviationAndNeverLeaveTheirRange) {
  const auto y =
      numbers(R"({"standard_deviation": 2, "mean": 1, "distribution": "uniform"})", {0, 1, 0, 99}, 200000);
  EXPECT_NEAR(mean_of(y, [](double x) { return x; }), 1, 5 * 2 * std::sqrt(1 / 2e5));
  EXPECT_NEAR(mean_of(y, [](double x) { return (x - 1) * (x - 1); }), 4, 5 * 4 * std::sqrt(0.8 / 2e5));
  for (double x : y) ASSERT_LT(std::abs(x - 1), 2 * std::numbers::sqrt3);
}

TEST(Noise, IsWhiteAndIndependentBetweenRunsBlocksSeedsAndStreams) {
  const char* settings = R"({"standard_deviation": 1})";
  const auto y = numbers(settings, {0, 1, 0, 99}, 100000);
  for (size_t shift : {1u, 2u, 3u, 17u})
    EXPECT_LT(std::abs(correlation(y, y, shift)), 5 / std::sqrt(1e5)) << shift;
  for (const auto& other :
       {numbers(settings, {0, 1, 1, 99}, 100000), numbers(settings, {0, 1, 0, 100}, 100000),
        numbers(settings, {0, 2, 0, 99}, 100000),
        numbers(R"({"standard_deviation": 1, "stream": 1})", {0, 1, 0, 99}, 100000)})
    for (size_t shift : {0u, 1u})
      EXPECT_LT(std::abs(correlation(y, other, shift)), 5 / std::sqrt(1e5)) << shift;
}

TEST(Noise, IsTheSameAgainForTheSameSeed) {
  const loopwright::Setup setup{0, 7, 3, 12345};
  EXPECT_EQ(numbers(R"({"standard_deviation": 1})", setup, 100),
            numbers(R"({"standard_deviation": 1})", setup, 100));
}

TEST(Noise, HoldsItsNumberBetweenSamples) {
  BlockUnderTest noise("Noise", R"({"standard_deviation": 1})", 0.001);
  noise.evaluate(0);
  const double y = noise.output("y");
  noise.evaluate(0.0005);
  EXPECT_EQ(noise.output("y"), y);
  noise.update();
  noise.evaluate(0.001, 1);
  EXPECT_NE(noise.output("y"), y);
}

}  // namespace loopwright::noise_test
