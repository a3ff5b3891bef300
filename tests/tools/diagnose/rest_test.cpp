// What an axis at rest says about dry friction.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"
#include "tools/diagnose/predict/axis_model.h"

namespace loopwright::rest_test {
namespace {

using diagnosis::AxisModel;

bool holds_at_rest(const std::string& friction) {
  HiddenMachine machine;
  machine.viscous = friction;
  HiddenAxis axis(machine);
  const std::string experiment = axis.record("record", axis.nominal(), there_and_back(0.1, 0.2));
  return AxisModel(axis.diagram(), experiment, {}).holds_at_rest(1e-3);
}

TEST(Rest, AnAxisIsHeldByDryFrictionThatYieldsTooButNotByViscousFriction) {
  EXPECT_FALSE(holds_at_rest(""));
  EXPECT_TRUE(holds_at_rest(
      R"("viscous": {"type": "CoulombFriction", "mass": {"value": 0.2621, "unit": "kg"}, "level": {"value": 0.3, "unit": "N"}, "in": {"velocity": "mass.velocity", "applied": "motor.y"}})"));
  EXPECT_TRUE(holds_at_rest(
      R"("viscous": {"type": "PreslidingFriction", "level": {"value": 0.3, "unit": "N"}, "transition_distance": {"value": 1e-5, "unit": "m"},
                     "in": {"position": "mass.position", "velocity": "mass.velocity"}})"));
}

/// A reference that leaps makes a controller kick: for a moment with thousands of newtons, beside which a force
/// that drives the axis all the time looks small.
TEST(Rest, KicksOfAControllerHideNoFriction) {
  HiddenMachine machine;
  machine.force_noise = 0.06;
  HiddenAxis axis(machine);
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.15;
  WantedMotion motion;
  motion.rest(0.3);
  for (int i = 0; i < 16; ++i) motion.stroke(i % 2 ? -0.3 : 0.3, 0.5, 1.2);  // the ramps overlap: leaps
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, motion)}, {});
  EXPECT_NE(d.verdict, Verdict::nothing_missing) << to_text(d);
}

/// At each end the axis turns so slowly that it seems to rest for a tenth of a second, and moves there as a
/// free one does.
TEST(Rest, AnAxisThatTurnsSlowlyContradictsNoFriction) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.05;
  WantedMotion motion;
  motion.rest(0.3);
  for (int i = 0; i < 16; ++i) motion.stroke(i % 2 ? -0.4 : 0.4, i % 4 < 2 ? 0.5 : 0.3, 0.8);
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, motion)}, {});
  EXPECT_THAT(names(d), testing::ElementsAre("coulomb_friction")) << to_text(d);
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
}

}  // namespace
}  // namespace loopwright::rest_test
