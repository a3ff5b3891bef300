#include "tools/report/thin.h"
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <random>

namespace loopwright::report::thin_test {
namespace {

TEST(Thin, KeepsAllOfAShortSeries) {
  const std::vector<double> y = {3, 1, 2};
  EXPECT_EQ(thin(y, 3), (std::vector<size_t>{0, 1, 2}));
  EXPECT_TRUE(thin({}, 3).empty());
}

TEST(Thin, KeepsEveryPeakOfEveryStretch) {
  std::vector<double> y(100'000);
  for (size_t i = 0; i < y.size(); ++i) y[i] = std::sin(0.37 * double(i));
  y[777] = 5;
  y[54'321] = -7;
  const auto kept = thin(y, 1000);
  EXPECT_LE(kept.size(), 1000u);
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end()));
  EXPECT_EQ(std::adjacent_find(kept.begin(), kept.end()), kept.end());
  for (const size_t peak : {size_t{0}, size_t{777}, size_t{54'321}, y.size() - 1})
    EXPECT_TRUE(std::binary_search(kept.begin(), kept.end(), peak)) << peak;
}

TEST(Thin, KeepsGaps) {
  std::vector<double> y(10'000, 1.0);
  y[0] = y[5'005] = NAN;
  y[9'999] = INFINITY;
  y[3] = 2;
  const auto kept = thin(y, 100);
  for (const size_t index : {0, 3, 5'005, 9'999})
    EXPECT_TRUE(std::binary_search(kept.begin(), kept.end(), index)) << index;
  const std::vector<double> nothing(1000, NAN);
  EXPECT_FALSE(thin(nothing, 100).empty());
}

TEST(Thin, AVeryLowLimitStillKeepsTheExtremes) {
  const std::vector<double> y = {0, 9, 0, 0, 0, -9, 0, 0};
  EXPECT_EQ(thin(y, 1), (std::vector<size_t>{0, 1, 5, 7}));
}

TEST(CurveSummary, ThinsEveryPartAsIfItSawAllSamples) {
  std::vector<double> y(20'000);
  for (size_t i = 0; i < y.size(); ++i)
    y[i] = std::round(20 * std::sin(0.37 * double(i)));  // with equal peaks
  for (size_t i = 0; i < y.size(); i += 977) y[i] = i % 2 ? NAN : INFINITY;
  for (size_t i = 5'000; i < 6'000; ++i) y[i] = NAN;
  const CurveSummary summary(y);
  for (size_t begin : {0u, 1u, 255u, 256u, 5'100u, 7'777u})
    for (size_t end : {begin + 3, begin + 256, begin + 700, size_t(15'360), y.size() - 1, y.size()}) {
      const std::span<const double> part = std::span(y).subspan(begin, end - begin);
      for (size_t limit : {1u, 100u, 999u}) {
        auto expected = thin(part, limit);
        for (size_t& i : expected) i += begin;
        ASSERT_EQ(summary.thin(y, begin, end, limit), expected) << begin << " to " << end;
      }
      double lowest = INFINITY, highest = -INFINITY, sum_of_squares = 0;
      for (double v : part)
        if (sum_of_squares += v * v; std::isfinite(v))
          lowest = std::min(lowest, v), highest = std::max(highest, v);
      const auto range = summary.range(y, begin, end);
      if (lowest > highest) {
        EXPECT_TRUE(std::isnan(range.lowest) && std::isnan(range.highest));
        continue;
      }
      EXPECT_EQ(range.lowest, lowest);
      EXPECT_EQ(range.highest, highest);
      if (std::isfinite(sum_of_squares))
        EXPECT_NEAR(range.sum_of_squares, sum_of_squares, 1e-12 * sum_of_squares);
      else
        EXPECT_FALSE(std::isfinite(range.sum_of_squares));
    }
}

namespace {

/// Rises and falls, equal neighbours, peaks of one sample, gaps of one sample and of thousands.
std::vector<double> curve_with_gaps(size_t size, std::mt19937& random) {
  std::vector<double> y(size);
  double value = 0;
  size_t gap = 0;
  for (double& sample : y) {
    if (random() % 3) value = std::round(value + double(random() % 7) - 3);
    if (random() % 5000 == 0) gap = random() % 3 ? 1 : random() % 4000;
    sample = random() % 997 == 0 ? 1e4 * (double(random() % 3) - 1) : value;
    if (gap > 0) --gap, sample = random() % 4 ? NAN : INFINITY;
  }
  return y;
}

}  // namespace

/// Windows and numbers of stretches drawn at random: nothing that all samples would show is lost.
TEST(CurveSummary, LosesNoExtremeOfAnyWindow) {
  std::mt19937 random(11);
  for (const size_t size : {1u, 63u, 64u, 1'024u, 20'000u, 300'000u}) {
    const std::vector<double> y = curve_with_gaps(size, random);
    const CurveSummary summary(y);
    for (int attempt = 0; attempt < 60; ++attempt) {
      const size_t begin = random() % size, end = begin + 1 + random() % (size - begin);
      const size_t limit = 1 + random() % (attempt % 2 ? 40 : 3000);
      const std::vector<size_t> kept = summary.thin(y, begin, end, limit);
      std::vector<size_t> expected = thin(std::span(y).subspan(begin, end - begin), limit);
      for (size_t& i : expected) i += begin;
      ASSERT_EQ(kept, expected) << begin << " to " << end << " of " << size << ", " << limit;
      const size_t stretches = end - begin <= limit ? end - begin : std::max<size_t>(1, limit / 5);
      size_t at = 0;
      for (size_t k = 0; k < stretches; ++k) {
        const size_t from = begin + (end - begin) * k / stretches,
                     to = begin + (end - begin) * (k + 1) / stretches;
        double lowest = INFINITY, highest = -INFINITY, kept_lowest = INFINITY, kept_highest = -INFINITY;
        bool has_gap = false, keeps_gap = false;
        const auto take = [](double value, double& low, double& high, bool& gap) {
          if (!std::isfinite(value)) return void(gap = true);
          low = std::min(low, value), high = std::max(high, value);
        };
        for (size_t i = from; i < to; ++i) take(y[i], lowest, highest, has_gap);
        for (; at < kept.size() && kept[at] < to; ++at)
          take(y[kept[at]], kept_lowest, kept_highest, keeps_gap);
        ASSERT_EQ(kept_lowest, lowest);
        ASSERT_EQ(kept_highest, highest);
        ASSERT_EQ(keeps_gap, has_gap);
      }
    }
  }
}

TEST(FairLimit, LetsShortSeriesLiveAndSharesTheRest) {
  EXPECT_EQ(fair_limit({10, 1000, 1000}, 210), 100u);
  EXPECT_EQ(fair_limit({50, 50}, 99), 49u);
  EXPECT_GE(fair_limit({50, 50}, 100), 50u);
  EXPECT_GE(fair_limit({}, 100), 100u);
}

}  // namespace
}  // namespace loopwright::report::thin_test
