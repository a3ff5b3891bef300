// Laws of dry friction that differ where the motion turns, and nearly nowhere else.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed_axis.h"

namespace loopwright::friction_at_reversals_test {
namespace {

using testing::ElementsAre;

/// Fast strokes with few reversals, which are over within milliseconds.
FlawedMachine fast_machine() {
  FlawedMachine machine;
  machine.top_speed = 1.2, machine.duration = 6, machine.coulomb = 0.6;
  return machine;
}

TEST(FrictionAtReversals, HysteresisOfAShortDistanceIsNamedWithIt) {
  FlawedMachine machine = fast_machine();
  machine.presliding = 2e-4;
  const Diagnosis d = diagnosed(machine);
  EXPECT_EQ(name_of(d.verdict), "explained") << to_text(d);
  ASSERT_THAT(names(d), ElementsAre("presliding_hysteresis")) << to_text(d);
  EXPECT_TRUE(d.effects[0].alternatives.empty()) << to_text(d);
  expect_parameter(d.effects[0], "distance", 2e-4, 1e-4, "m");
  expect_parameter(d.effects[0], "level", 0.6, 0.02, "N");
}

TEST(FrictionAtReversals, DryFrictionThatTurnsAtOnceStaysDryFriction) {
  const Diagnosis d = diagnosed(fast_machine());
  EXPECT_EQ(name_of(d.verdict), "explained") << to_text(d);
  ASSERT_THAT(names(d), ElementsAre("coulomb_friction")) << to_text(d);
  EXPECT_TRUE(d.effects[0].alternatives.empty()) << to_text(d);
}

}  // namespace
}  // namespace loopwright::friction_at_reversals_test
