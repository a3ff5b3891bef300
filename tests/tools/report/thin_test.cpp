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

TEST(FairLimit, LetsShortSeriesLiveAndSharesTheRest) {
  EXPECT_EQ(fair_limit({10, 1000, 1000}, 210), 100u);
  EXPECT_EQ(fair_limit({50, 50}, 99), 49u);
  EXPECT_GE(fair_limit({50, 50}, 100), 50u);
  EXPECT_GE(fair_limit({}, 100), 100u);
}

}  // namespace
}  // namespace loopwright::report
