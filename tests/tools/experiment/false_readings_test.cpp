// Single readings that do not belong to their rows are recognized, and what only looks like them is not.
#include "tools/experiment/false_readings.h"
#include <gmock/gmock.h>
#include <cmath>
#include <numeric>

namespace loopwright {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A swing of the given size, on counts if there are any.
std::vector<double> swing(double size, double count = 0) {
  std::vector<double> value;
  for (int k = 0; k < 2000; ++k) {
    const double x = size * std::sin(0.01 * k);
    value.push_back(count > 0 ? count * std::round(x / count) : x);
  }
  return value;
}
std::vector<double> rows_of(const std::vector<double>& value) {
  std::vector<double> at(value.size());
  std::iota(at.begin(), at.end(), 0.0);
  return at;
}

TEST(FalseReadings, OldValuesAreFoundAndReplaced) {
  const std::vector<double> true_value = swing(1, 1e-4);
  std::vector<double> value = true_value;
  value[300] = value[299];
  value[601] = value[602] = value[600];
  const std::vector<size_t> rows = false_readings(value);
  EXPECT_THAT(rows, ElementsAre(300, 601, 602));
  replace_readings(rows_of(value), value, rows);
  for (const size_t row : rows) EXPECT_NEAR(value[row], true_value[row], 3e-4);
}

TEST(FalseReadings, ALeapOutAndBackIsOne) {
  std::vector<double> value = swing(1, 1e-4);
  value[700] += 0.3;
  EXPECT_THAT(false_readings(value), ElementsAre(700));
}

TEST(FalseReadings, CountsRestAndBlowsAreNone) {
  EXPECT_THAT(false_readings(swing(1, 0.01)), IsEmpty()) << "a count a row, and less";
  EXPECT_THAT(false_readings(swing(1)), IsEmpty());
  std::vector<double> blow = swing(1, 1e-4);
  for (size_t k = 700; k < blow.size(); ++k) blow[k] = blow[700];  // it hits a stop and rests
  EXPECT_THAT(false_readings(blow), IsEmpty());
  std::vector<double> begins(500, 0.0);
  for (int k = 0; k < 500; ++k) begins.push_back(0.01 * k);
  EXPECT_THAT(false_readings(begins), IsEmpty());
}

TEST(FalseReadings, ACommandLeapsAlsoLessFarAndToZero) {
  std::vector<double> value = swing(100);
  for (size_t k = 0; k < value.size(); ++k) value[k] += k % 2 ? 0.1 : -0.1;
  value[450] += 4;
  value[800] = 0;
  EXPECT_THAT(leaps_out_and_back(value), ElementsAre(800));
  EXPECT_THAT(leaps_out_and_back(value, 5), ElementsAre(450, 800));
  EXPECT_THAT(single_zeros(value), ElementsAre(800));
  std::vector<double> crossing = swing(100);
  crossing[314] = 0;  // where it is near zero
  std::vector<double> pulses(500, 0.0);
  for (size_t k = 0; k < 500; k += 2) pulses[k] = 10;
  EXPECT_THAT(single_zeros(crossing), IsEmpty());
  EXPECT_THAT(single_zeros(pulses), IsEmpty());
}

TEST(FalseReadings, WithoutNeighboursOneKeepsItsValue) {
  std::vector<double> value{1, 2, 3, 4, 5};
  const std::vector<size_t> rows{1, 4};
  replace_readings(rows_of(value), value, rows);
  EXPECT_THAT(value, ElementsAre(1, 2, 3, 4, 5));
}

}  // namespace
}  // namespace loopwright
