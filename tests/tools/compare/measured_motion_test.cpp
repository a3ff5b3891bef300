// Where a motion of which only the velocity was measured begins.
#include "tools/compare/machine.h"
#include <gtest/gtest.h>
#include "tests/tools/diagnose/flawed_axis.h"

namespace loopwright::measured_motion_test {
namespace {

TEST(MeasuredMotion, OfAVelocityBeginsWhereTheDiagramDoes) {
  FlawedMachine machine;
  machine.velocity_noise = 5e-5, machine.cogging = 0.8, machine.cogging_is_known = true;
  machine.origin = 0.0043, machine.duration = 4;
  const FlawedAxis axis(machine);
  Problems problems;
  const auto experiment = load_experiment(axis.experiment(), problems);
  ASSERT_TRUE(experiment) << problems.text();
  std::string why;
  const auto found = find_machine(axis.diagram(), *experiment, {}, why);
  ASSERT_TRUE(found) << why;
  EXPECT_DOUBLE_EQ(found->motion.position.front(), machine.origin);
  EXPECT_DOUBLE_EQ(found->motion.raw_position.front(), machine.origin);
}

}  // namespace
}  // namespace loopwright::measured_motion_test
