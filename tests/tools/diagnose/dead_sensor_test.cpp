// Sensors that do not answer, or begin anew.
#include "tools/diagnose/record/dead_sensor.h"
#include <gmock/gmock.h>
#include <cmath>
#include <numbers>

namespace loopwright::diagnosis {
namespace {

constexpr double turn = 2 * std::numbers::pi;

/// 2000 rows of a shaft that goes forth and back, by so many turns a row at most.
std::vector<double> shaft(double fastest) {
  std::vector<double> angle{0.3};
  for (size_t k = 1; k < 2000; ++k)
    angle.push_back(angle.back() + turn * fastest * std::sin(2e-3 * turn * double(k)));
  return angle;
}

TEST(DeadSensor, AnAngleThatBeginsAnewAtEachTurnIsSeen) {
  std::vector<double> angle = shaft(0.02);
  size_t wraps = 0;
  for (size_t k = 1; k < angle.size(); ++k)
    wraps += std::floor(angle[k] / turn) != std::floor(angle[k - 1] / turn);
  EXPECT_EQ(leaps_by_a_turn(angle), 0u);
  for (double& a : angle) a -= turn * std::floor(a / turn);
  EXPECT_EQ(leaps_by_a_turn(angle), wraps);
  EXPECT_GT(wraps, 10u);
}
TEST(DeadSensor, AShaftThatTurnsByATurnWithinARowDoesNotBeginAnew) {
  EXPECT_EQ(leaps_by_a_turn(shaft(1.1)), 0u);
}

}  // namespace
}  // namespace loopwright::diagnosis
