// A position and a velocity of one axis that contradict each other.
#include "tools/diagnose/record/two_sensors.h"
#include <gmock/gmock.h>
#include <cmath>

namespace loopwright::diagnosis {
namespace {

/// 4 s at 1 kHz, or longer; the position on counts of a micrometre, or others.
AxisRecord swinging(double gain, double lag_s = 0, double counts_per_metre = 1e6, size_t rows = 4000) {
  AxisRecord record;
  record.sample_time = 1e-3;
  MeasuredPort position, velocity;
  position.role = "position", velocity.role = "velocity";
  for (size_t k = 0; k < rows; ++k) {
    const double t = double(k) * 1e-3;
    position.value.push_back(std::round(counts_per_metre * 0.2 * std::sin(5 * t)) / counts_per_metre);
    velocity.value.push_back(gain * std::cos(5 * (t - lag_s)) + 1e-3 * std::sin(1e4 * t));
    record.input.push_back(0);
  }
  record.measured = {position, velocity};
  return record;
}

TEST(TwoSensors, AnotherScaleIsSeen) {
  const std::optional<double> ratio = velocity_over_rate(swinging(1.04));
  ASSERT_TRUE(ratio);
  EXPECT_NEAR(*ratio, 1.04, 1e-3);
  EXPECT_NEAR(velocity_over_rate(swinging(57.3)).value_or(0), 57.3, 0.1) << "degrees for radians";
}
TEST(TwoSensors, AgreeBesideCountsNoiseAndAShortFilter) {
  EXPECT_FALSE(velocity_over_rate(swinging(1)));
  EXPECT_FALSE(velocity_over_rate(swinging(1.003))) << "as good as sensors are";
  EXPECT_FALSE(velocity_over_rate(swinging(1, 5e-3)));
}
/// The way by the position is uncertain, which makes a regression on it too flat: a long record is sure of
/// that.
TEST(TwoSensors, AgreeBesideCoarseCounts) {
  EXPECT_FALSE(velocity_over_rate(swinging(1, 0, 50, 100000)));
  EXPECT_NEAR(velocity_over_rate(swinging(1.3, 0, 500, 100000)).value_or(0), 1.3, 0.02);
}
TEST(TwoSensors, OneSensorContradictsNothing) {
  AxisRecord record = swinging(2);
  record.measured.pop_back();
  EXPECT_FALSE(velocity_over_rate(record));
}
TEST(TwoSensors, RowsThatAreMissingTellNoWay) {
  AxisRecord record = swinging(1);
  record.missing.assign(record.rows(), 0);
  for (size_t k = 500; k < 4000; k += 400)
    for (size_t i = 0; i < 150; ++i) record.missing[k + i] = 1, record.measured[1].value[k + i] = 0;
  EXPECT_FALSE(velocity_over_rate(record));
}

}  // namespace
}  // namespace loopwright::diagnosis
