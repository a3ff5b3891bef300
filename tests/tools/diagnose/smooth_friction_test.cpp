// Friction that rises with speed to a level, as most simulated machines have it: neither dry nor viscous.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/flawed_axis.h"

namespace loopwright::smooth_friction_test {
namespace {

using testing::ElementsAre;

/// Of 0.4 N that rise over a speed.
Diagnosis diagnosed(double speed) {
  FlawedMachine machine;
  machine.smooth_friction = 0.4, machine.smooth_speed = speed;
  const FlawedAxis axis(machine);
  return diagnose(axis.diagram(), {axis.experiment()});
}

TEST(SmoothFriction, IsNamedWithItsLevelAndSpeed) {
  const Diagnosis d = diagnosed(0.04);
  EXPECT_EQ(name_of(d.verdict), "explained") << to_text(d);
  ASSERT_THAT(names(d), ElementsAre("smooth_friction")) << to_text(d);
  expect_parameter(d.effects[0], "level", 0.4, 0.02, "N");
  expect_parameter(d.effects[0], "speed", 0.04, 0.004, "m/s");
}

TEST(SmoothFriction, OfVerySmallSpeedsIsDryFriction) {
  const Diagnosis d = diagnosed(0.0005);
  EXPECT_EQ(name_of(d.verdict), "explained") << to_text(d);
  EXPECT_THAT(names(d), ElementsAre("coulomb_friction")) << to_text(d);
}

}  // namespace
}  // namespace loopwright::smooth_friction_test
