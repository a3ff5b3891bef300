// A load that is driven through a gap, by the generator's plant: what it hangs on is found as it is.
#include <gmock/gmock.h>
#include <numbers>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"

namespace loopwright::flying_load_test {
namespace {

using testing::ElementsAre;

constexpr double load = 0.1, gap = 3e-4, frequency = 60, ratio = 0.2;

Physics with_backlash(const HiddenAxis& axis) {
  Physics truth = axis.nominal();
  const double rate = 2 * std::numbers::pi * frequency;
  truth.load_kg = load, truth.gap_m = gap;
  truth.coupling_n_per_m = load * rate * rate, truth.coupling_n_s_per_m = 2 * ratio * load * rate;
  truth.load_damping_n_s_per_m = truth.damping_n_s_per_m * load / truth.mass_kg;
  return truth;
}

/// Strokes to and fro, in each of which the load flies from flank to flank.
WantedMotion many_strokes() {
  WantedMotion motion;
  motion.rest(0.2);
  for (int i = 0; i < 40; ++i)
    for (double sign : {1.0, -1.0})
      motion.stroke(sign * 0.03, 0.1 + 0.01 * (i % 7), 0.06 + 0.01 * (i % 3)).rest(0.04);
  return motion;
}

double value_of(const Diagnosis& found, const std::string& name) {
  for (const DiagnosedParameter& p : found.effects.front().parameters)
    if (p.name == name) return p.value;
  return NAN;
}

/// Along a predicted path alone the load comes late in each blow, and a contact that is too hard makes up for
/// it.
TEST(FlyingLoad, MassGapAndContactAreThoseOfThePlant) {
  HiddenAxis axis;
  const std::string record = axis.record("backlash", with_backlash(axis), many_strokes());
  const Diagnosis found = diagnose(axis.diagram(), {record}, {});
  ASSERT_THAT(names(found), ElementsAre("backlash")) << to_text(found);
  EXPECT_EQ(found.verdict, Verdict::explained) << to_text(found);
  EXPECT_NEAR(value_of(found, "load_mass") / load, 1, 0.02);
  EXPECT_NEAR(value_of(found, "gap") / gap, 1, 0.02);
  EXPECT_NEAR(value_of(found, "contact_frequency") / frequency, 1, 0.02);
  EXPECT_NEAR(value_of(found, "contact_damping") / ratio, 1, 0.1);
}

/// The catalogue holds a load by viscous friction alone. With dry friction it is another one, with another
/// gap.
TEST(FlyingLoad, WithDryFrictionOfItsOwnIsNotExplained) {
  HiddenAxis axis;
  Physics truth = with_backlash(axis);
  truth.load_friction_n = 0.3;
  const Diagnosis found = diagnose(axis.diagram(), {axis.record("held_load", truth, many_strokes())}, {});
  EXPECT_EQ(name_of(found.verdict), "partly_explained") << to_text(found);
}

}  // namespace
}  // namespace loopwright::flying_load_test
