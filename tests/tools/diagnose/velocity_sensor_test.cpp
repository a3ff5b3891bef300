// A velocity sensor alone, on a machine whose diagram has forces that depend on the position: nobody measures
// where it is, but it is where the velocity has brought it since the start.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed_axis.h"

namespace loopwright::velocity_sensor_test {
namespace {

using testing::ElementsAre;

/// Its cogging rises and falls faster than a spring of 400 N/m would push.
FlawedMachine machine_with_known_cogging() {
  FlawedMachine machine;
  machine.velocity_noise = 5e-5;
  machine.cogging = 0.8, machine.pitch = 0.012, machine.cogging_is_known = true, machine.origin = 0.0043;
  return machine;
}

TEST(VelocitySensor, WithKnownCoggingNothingIsMissing) {
  const Diagnosis d = diagnosed(machine_with_known_cogging());
  EXPECT_EQ(name_of(d.verdict), "nothing_missing") << to_text(d);
}

TEST(VelocitySensor, BesideKnownCoggingFrictionIsNamed) {
  FlawedMachine machine = machine_with_known_cogging();
  machine.coulomb = 0.4;
  const Diagnosis d = diagnosed(machine);
  EXPECT_EQ(name_of(d.verdict), "explained") << to_text(d);
  ASSERT_THAT(names(d), ElementsAre("coulomb_friction")) << to_text(d);
  expect_parameter(d.effects[0], "level", 0.4, 0.02, "N");
}

}  // namespace
}  // namespace loopwright::velocity_sensor_test
