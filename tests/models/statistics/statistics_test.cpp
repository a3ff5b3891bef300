// Order statistics, prices of models, and whiteness against numbers worked out by hand.
#include <gtest/gtest.h>
#include <cmath>
#include <limits>
#include "models/random/philox.h"
#include "models/statistics/information_criterion.h"
#include "models/statistics/portmanteau.h"
#include "models/statistics/quantile.h"

namespace loopwright::statistics_test {
namespace {

TEST(Quantile, IsTheValueOfNearestRank) {
  const std::vector<double> values{3, 1, 2, 5, 4};
  EXPECT_EQ(quantile(values, 0), 1);
  EXPECT_EQ(quantile(values, 0.5), 3);
  EXPECT_EQ(quantile(values, 0.6), 3);
  EXPECT_EQ(quantile(values, 0.7), 4);
  EXPECT_EQ(quantile(values, 1), 5);
  EXPECT_EQ(quantile(std::vector{7.0}, 0.99), 7);
  EXPECT_EQ(quantile(std::vector{1.0, std::numeric_limits<double>::infinity()}, 0), 1);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
  EXPECT_EQ(lower_quantile(values, 0.7), 3);
  EXPECT_EQ(lower_quantile(values, 1), 5);
  EXPECT_TRUE(std::isnan(lower_quantile({}, 0.5)));
}

TEST(ExtendedBayesianPrice, CountsParametersAndChoices) {
  EXPECT_NEAR(extended_bayesian_price(2, 1, 1000, 40), 2 * std::log(1000.0) + 2 * std::log(40.0), 1e-12);
  EXPECT_EQ(extended_bayesian_price(0, 0, 1000, 40), 0);
}

TEST(Portmanteau, IsNothingBesideOnesThatSumToZeroAtEveryLag) {
  EXPECT_EQ(lagged_products_of(std::vector{1.0, 2.0, 3.0}, 2), (std::vector{14.0, 8.0, 3.0}));
  EXPECT_NEAR(portmanteau(std::vector{14.0, 8.0, 3.0}, 3), 3 * (64 + 9) / 196.0, 1e-12);
  EXPECT_EQ(portmanteau(std::vector{0.0, 0.0}, 3), 0);
  EXPECT_EQ(portmanteau({}, 3), 0);
}

TEST(Portmanteau, IsNearTheNumberOfLagsForWhiteErrorsAndFarAboveForColouredOnes) {
  constexpr size_t lags = 40, rows = 20000;
  std::vector<double> white(rows), coloured(rows);
  for (size_t k = 0; k < rows; ++k) {
    white[k] = uniform_pair(3, 0, k).first - 0.5;
    coloured[k] = white[k] + (k > 0 ? 0.1 * coloured[k - 1] : 0.0);
  }
  EXPECT_NEAR(portmanteau(lagged_products_of(white, lags), double(rows)), lags, 4 * std::sqrt(2.0 * lags));
  EXPECT_GT(portmanteau(lagged_products_of(coloured, lags), double(rows)), 0.9 * 0.01 * double(rows));
}

}  // namespace
}  // namespace loopwright::statistics_test
