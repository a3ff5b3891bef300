#include "tools/report/thin.h"
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>

namespace loopwright::report {
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

TEST(FairLimit, LetsShortSeriesLiveAndSharesTheRest) {
  EXPECT_EQ(fair_limit({10, 1000, 1000}, 210), 100u);
  EXPECT_EQ(fair_limit({50, 50}, 99), 49u);
  EXPECT_GE(fair_limit({50, 50}, 100), 50u);
  EXPECT_GE(fair_limit({}, 100), 100u);
}

}  // namespace
}  // namespace loopwright::report
