// The noise floor is a property of the record, not of the unit in which its position is given.
#include "tools/compare/smoother.h"
#include <gtest/gtest.h>
#include <cmath>
#include "models/random/philox.h"

namespace loopwright::smoother_test {
namespace {

/// Strokes of 0.3 m at 0.5 Hz with friction, a ripple of 30 mm and noise of 0.05 N; the position in units of
/// so many meters.
Rows strokes(double unit) {
  Rows rows;
  for (size_t i = 0; i < 4000; ++i) {
    const double t = 0.005 * double(i), w = 3.14159, x = 0.15 * std::sin(w * t),
                 v = 0.15 * w * std::cos(w * t);
    const auto word = philox({uint32_t(i), 0, 0, 0}, {1u, 2u})[0];
    const double noise = 0.05 * std::sqrt(12.0) * (double(word) / 4294967296.0 - 0.5);
    rows.index.push_back(i), rows.time.push_back(t), rows.block.push_back(int(t / 0.4));
    rows.position.push_back(x / unit), rows.velocity.push_back(v / unit);
    rows.acceleration.push_back(-w * w * x / unit);
    rows.residual.push_back((v > 0 ? 2 : -2) + 3 * v + std::sin(2 * 3.14159 * x / 0.03) + noise);
  }
  rows.blocks = rows.block.back() + 1;
  return rows;
}

TEST(NoiseFloor, DoesNotDependOnTheUnitOfThePosition) {
  const double in_meters = floor_of_smooth_parts(strokes(1));
  EXPECT_NEAR(in_meters, 0.05, 0.02);
  for (const double unit : {1e-6, 1e-3, 0.01 / (2 * 3.14159), 10.0})
    EXPECT_NEAR(floor_of_smooth_parts(strokes(unit)), in_meters, 1e-6 * in_meters) << unit;
}

}  // namespace
}  // namespace loopwright::smoother_test
