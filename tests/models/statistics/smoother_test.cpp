// Functions of one variable that are fitted in some rows and judged in others.
#include "models/statistics/smoother.h"
#include <gtest/gtest.h>
#include <cmath>
#include "models/random/philox.h"

namespace loopwright::hats_test {
namespace {

constexpr size_t rows = 4000, folds = 5, block = 50;

std::vector<double> uniform(uint64_t source) {
  std::vector<double> values(rows);
  for (size_t k = 0; k < rows; ++k) values[k] = uniform_pair(5, source, k).first;
  return values;
}

CrossValidation over(const std::vector<double>& variable, const Hats& hats) {
  CrossValidation validation{{}, hats.count(), {}, folds};
  for (size_t k = 0; k < rows; ++k)
    validation.places.push_back(hats.at(variable[k])), validation.fold.push_back(k / block % folds);
  return validation;
}

TEST(Hats, LieAtEqualDistances) {
  const Hats hats = Hats::at_equal_distances(std::vector{2.0, -2.0, 0.5}, 5);
  ASSERT_EQ(hats.count(), 5u);
  EXPECT_EQ(hats.at(-2).knot, 0u);
  EXPECT_EQ(hats.at(0.25).knot, 2u);
  EXPECT_NEAR(hats.at(0.25).weight, 0.25, 1e-12);
  EXPECT_EQ(hats.at(-7).weight, 0);
  EXPECT_EQ(hats.at(7).knot, 3u);
  EXPECT_EQ(hats.at(7).weight, 1);
}

TEST(Hats, LieBetweenQuantilesAndOnceWhereValuesRepeat) {
  const Hats hats = Hats::between_quantiles(std::vector{0.0, 0.0, 0.0, 1.0, 10.0}, 5);
  ASSERT_EQ(hats.count(), 3u);
  EXPECT_NEAR(hats.at(5.5).weight, 0.5, 1e-12);
  EXPECT_EQ(Hats::at_equal_distances(std::vector{4.0, 4.0}, 5).count(), 1u);
  EXPECT_EQ(Hats::between_quantiles({}, 5).count(), 0u);
}

TEST(CrossValidation, SeesAFunctionOfTheVariableAndNoneOfAnother) {
  const std::vector<double> variable = uniform(0), other = uniform(1);
  std::vector<double> signal(rows);
  for (size_t k = 0; k < rows; ++k) signal[k] = std::abs(variable[k] - 0.5) - 0.25;
  EXPECT_GT(over(variable, Hats::at_equal_distances(variable, 11)).share_of(signal), 0.999);
  const double none = over(other, Hats::at_equal_distances(other, 11)).share_of(signal);
  EXPECT_LT(none, 0);
  EXPECT_GT(none, -0.02);
}

TEST(CrossValidation, JudgesRowsThatWereNotFitted) {
  // A hat for each fold: what is learned in the others says nothing about this one.
  std::vector<double> variable(rows), signal(rows);
  for (size_t k = 0; k < rows; ++k) variable[k] = double(k / block % folds), signal[k] = 1;
  EXPECT_NEAR(over(variable, Hats::at_equal_distances(variable, folds)).share_of(signal), 0, 1e-6);
}

TEST(CrossValidation, IsZeroForASignalOfZeros) {
  const std::vector<double> variable = uniform(0);
  EXPECT_EQ(over(variable, Hats::at_equal_distances(variable, 4)).share_of(std::vector<double>(rows)), 0);
}

}  // namespace
}  // namespace loopwright::hats_test
