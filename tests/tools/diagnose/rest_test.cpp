// What an axis at rest says about dry friction.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"
#include "tools/diagnose/predict/axis_model.h"
#include "tools/diagnose/search/prepare.h"
#include "tools/diagnose/search/rest.h"

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

/// A reference that leaps makes a controller kick: for a moment with thousands of newtons, beside which a
/// force that drives the axis all the time looks small.
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

/// Noise moves an axis that slides as it moves a free one, however slowly it slides.
TEST(Rest, AnAxisThatSlidesSlowlyContradictsNoFriction) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.3;
  WantedMotion motion;
  motion.rest(0.2).stroke(0.1, 0.02, 0.1);
  diagnosis::Motion prepared;
  diagnosis::Trials trials =
      diagnosis::prepare(axis.diagram(), {axis.record("record", truth, motion)}, {}, prepared, {});
  diagnosis::Trial& trial = trials.list.front();
  for (size_t k = 0; k < trial.at_rest.size(); ++k)
    trial.at_rest[k] = k > 1000;  // as on a machine that is fast
  diagnosis::Candidate friction;
  friction.at_rest = AtRest::holds;
  EXPECT_EQ(against_at_rest(trials, {{&friction, {0.3}, {}}}, {}, trials.noise), 0);
}

}  // namespace
}  // namespace loopwright::rest_test
