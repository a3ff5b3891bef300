// A record that cannot distinguish two effects reports this. The suggested motion, made with the same hidden
// effect, distinguishes them.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"
#include "tools/effects/motion.h"

namespace loopwright::suggested_experiment_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// The motion that the catalogue describes in a suggestion, relative to the record.
WantedMotion suggested_motion(const SuggestedExperiment& suggestion, const WantedMotion& record,
                              const RecordSizes& sizes) {
  Problems problems;
  for (const Effect& effect : load_catalogue({catalogue_folder()}, problems)) {
    if (effect.name != suggestion.between) continue;
    for (const ConfusableEffect& other : effect.confusable) {
      if (other.with != suggestion.and_effect) continue;
      EXPECT_EQ(other.experiment.text, suggestion.text);
      EXPECT_EQ(other.experiment.added_mass, 0);
      const Motion motion = motion_of(other.experiment, sizes);
      return {motion.position, motion.added_force};
    }
  }
  ADD_FAILURE() << "no suggestion for " << suggestion.between << " and " << suggestion.and_effect;
  return record;
}

RecordSizes sizes_of(const WantedMotion& record, const HiddenAxis& axis) {
  RecordSizes sizes;
  const auto& x = record.position;
  const auto [low, high] = std::ranges::minmax_element(x);
  sizes.lowest_position = *low, sizes.highest_position = *high, sizes.stroke = *high - *low;
  for (size_t k = 1; k + 1 < x.size(); ++k) {
    const double speed = (x[k + 1] - x[k - 1]) / 2e-3, acceleration = (x[k + 1] - 2 * x[k] + x[k - 1]) / 1e-6;
    sizes.top_speed = std::max(sizes.top_speed, std::abs(speed));
    sizes.top_acceleration = std::max(sizes.top_acceleration, std::abs(acceleration));
  }
  sizes.force_level = sizes.input_level = axis.force_level(), sizes.sample_time = hidden_sample_time;
  return sizes;
}

/// Diagnoses a record, then this record together with the suggested one. The first must not distinguish the
/// two effects, whichever of them it names; the second must.
void expect_told_apart(HiddenAxis& axis, const Physics& truth, const WantedMotion& motion,
                       const std::string& hidden, const std::string& alike) {
  const std::string first = axis.record("first", truth, motion);
  const RecordSizes sizes = sizes_of(motion, axis);
  const Diagnosis before = diagnose(axis.diagram(), {first});
  ASSERT_EQ(before.effects.size(), 1u) << to_text(before);
  const DiagnosedEffect& named = before.effects.front();
  const std::string& other = named.name == hidden ? alike : hidden;
  ASSERT_THAT(named.name, testing::AnyOf(hidden, alike)) << to_text(before);
  ASSERT_THAT(named.alternatives, testing::Contains(other)) << to_text(before);
  EXPECT_THAT(to_text(before), HasSubstr("or " + other + ": these two cannot be told apart by this record"));
  const auto suggestion = std::ranges::find(before.suggested, other, &SuggestedExperiment::and_effect);
  ASSERT_NE(suggestion, before.suggested.end());
  const std::string second = axis.record("second", truth, suggested_motion(*suggestion, motion, sizes));
  const Diagnosis after = diagnose(axis.diagram(), {first, second});
  EXPECT_THAT(names(after), ElementsAre(hidden)) << to_text(after);
  EXPECT_EQ(after.verdict, Verdict::explained);
  ASSERT_FALSE(after.effects.empty());
  EXPECT_THAT(after.effects.front().alternatives, IsEmpty()) << to_text(after);
}

TEST(SuggestedExperiment, TwoDirectionsAreAskedForWhereThereIsOne) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.12;
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("forward", truth, one_way_without_rest(1))});
  ASSERT_FALSE(d.findings.empty());
  EXPECT_EQ(d.findings[0].what, "all motion goes one way");
  ASSERT_EQ(d.effects.size(), 1u) << to_text(d);
  EXPECT_THAT(to_text(d), HasSubstr("these two cannot be told apart by this record"));
  EXPECT_FALSE(d.suggested.empty());
}

TEST(SuggestedExperiment, TellsCoulombFrictionFromAConstantForce) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.15;
  expect_told_apart(axis, truth, one_way_without_rest(1), "coulomb_friction", "constant_force");
}

TEST(AtRest, FrictionHoldsAndAConstantForceDoesNotThoughAllMotionGoesOneWay) {
  HiddenAxis axis;
  Physics friction = axis.nominal(), force = axis.nominal();
  friction.coulomb_n = 0.15, force.offset_n = 0.15;
  const Diagnosis with_friction = diagnose(axis.diagram(), {axis.record("friction", friction, one_way(1))});
  EXPECT_THAT(names(with_friction), ElementsAre("coulomb_friction"));
  ASSERT_FALSE(with_friction.effects.empty());
  EXPECT_THAT(with_friction.effects[0].alternatives, Not(testing::Contains("constant_force")));
  const Diagnosis with_force = diagnose(axis.diagram(), {axis.record("force", force, one_way(1))});
  EXPECT_THAT(names(with_force), ElementsAre("constant_force"));
  ASSERT_FALSE(with_force.effects.empty());
  EXPECT_THAT(with_force.effects[0].alternatives, Not(testing::Contains("coulomb_friction")));
}

/// A controller that keeps the axis where it is pushes it with all that friction holds.
TEST(AtRest, FrictionHoldsWithinTheFirstTenthOfASecondToo) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.15;
  WantedMotion motion;
  motion.rest(0.09);
  for (double speed : {0.2, 0.4, 0.1, 0.3}) motion.stroke(0.15, speed, 0.1);
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("short", truth, motion)});
  EXPECT_THAT(names(d), ElementsAre("coulomb_friction")) << to_text(d);
}

Diagnosis with_spring_and_friction(const WantedMotion& motion) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.12, truth.spring_n_per_m = 1.5;
  return diagnose(axis.diagram(), {axis.record("record", truth, motion)});
}
TEST(ContainedFriction, IsDeclaredWhereThePreloadOfASpringPullsAsItDoes) {
  const Diagnosis d = with_spring_and_friction(one_way_without_rest(1));
  EXPECT_THAT(names(d), ElementsAre("spring")) << to_text(d);
  EXPECT_THAT(to_text(d),
              HasSubstr("or spring + coulomb_friction in the place of spring: this record cannot tell"));
  EXPECT_THAT(to_text(d),
              HasSubstr("To tell spring from coulomb_friction: Repeat the motion in both directions"));
}
/// The axis is pushed forward all the time, and brakes itself.
Diagnosis with_force_and_friction(double offset_n, double coulomb_n, const WantedMotion& motion) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.offset_n = offset_n, truth.coulomb_n = coulomb_n;
  return diagnose(axis.diagram(), {axis.record("record", truth, motion)});
}
TEST(ContainedFriction, IsDeclaredBesideAConstantForceThatIsLarger) {
  const Diagnosis d = with_force_and_friction(-0.4, 0.15, one_way(1));
  EXPECT_THAT(names(d), ElementsAre("constant_force")) << to_text(d);
  EXPECT_THAT(to_text(d), HasSubstr("or constant_force + coulomb_friction in the place of constant_force"));
}
TEST(ContainedFriction, IsNotDeclaredWhereRestShowsThatNothingHolds) {
  const Diagnosis d = with_force_and_friction(-0.4, 0, one_way(1));
  EXPECT_THAT(names(d), ElementsAre("constant_force")) << to_text(d);
  EXPECT_THAT(to_text(d), Not(HasSubstr("coulomb_friction in the place of")));
  EXPECT_EQ(d.verdict, Verdict::explained);
}
TEST(ContainedFriction, IsNamedWhereTheMotionGoesBothWays) {
  const Diagnosis d = with_spring_and_friction(there_and_back(0.15, 0.3));
  EXPECT_THAT(names(d), testing::UnorderedElementsAre("coulomb_friction", "spring")) << to_text(d);
  EXPECT_THAT(to_text(d), Not(HasSubstr("in the place of spring")));
}

TEST(SuggestedExperiment, TellsAConstantForceFromCoulombFriction) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.offset_n = 0.15;
  expect_told_apart(axis, truth, one_way_without_rest(1), "constant_force", "coulomb_friction");
}

TEST(SuggestedExperiment, TellsDampingFromFrictionThatDiffersWithTheDirection) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.added_damping_n_s_per_m = 1.2;
  expect_told_apart(axis, truth, one_way(1), "viscous_friction", "direction_dependent_friction");
}

TEST(SuggestedExperiment, TellsFrictionThatDiffersWithTheDirectionFromDamping) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.direction_damping_n_s_per_m = 1.2;
  expect_told_apart(axis, truth, one_way(1), "direction_dependent_friction", "viscous_friction");
}

/// Without a controller and below 3 Hz the command is so smooth that a delay and a lag of 3 ms differ by τ²/2
/// d²u/dt²: 0.1 mN beside 10 mN of noise.
WantedMotion smooth() {
  WantedMotion motion;
  for (double t = hidden_sample_time; t < 10; t += hidden_sample_time) {
    const double fade = std::pow(std::sin(std::numbers::pi * t / 10), 2);
    motion.position.push_back(fade *
                              (0.08 * std::sin(2 * t) + 0.02 * std::sin(7 * t) + 0.006 * std::sin(15 * t)));
  }
  return motion;
}

TEST(SuggestedExperiment, TellsADelayFromALag) {
  HiddenMachine machine;
  machine.has_controller = false;
  HiddenAxis axis(machine);
  Physics truth = axis.nominal();
  truth.delay_s = 0.003;
  expect_told_apart(axis, truth, smooth(), "input_delay", "actuator_lag");
}

TEST(SuggestedExperiment, TellsALagFromADelay) {
  HiddenMachine machine;
  machine.has_controller = false;
  HiddenAxis axis(machine);
  Physics truth = axis.nominal();
  truth.lag_s = 0.003;
  expect_told_apart(axis, truth, smooth(), "actuator_lag", "input_delay");
}

}  // namespace
}  // namespace loopwright::suggested_experiment_test
