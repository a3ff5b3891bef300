// Sensors that are read less often than the rows of the record, which the command fills.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/flawed_axis.h"
#include "tests/tools/diagnose/hidden_axis.h"
#include "tests/tools/diagnose/diagnosed_plant.h"
#include "tools/compare/compare.h"

namespace loopwright::several_rates_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Physics with_friction_and_cogging(const HiddenAxis& axis) {
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.15, truth.cogging = {0.1, 0.0225, 0.5};
  return truth;
}

void expect_friction_and_cogging(const Diagnosis& d) {
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
  ASSERT_THAT(names(d), testing::UnorderedElementsAre("coulomb_friction", "cogging")) << to_text(d);
  for (const DiagnosedEffect& effect : d.effects)
    if (effect.name == "cogging")
      expect_parameter(effect, "pitch", 0.0225, 2e-4, "m");
    else
      expect_parameter(effect, "level", 0.15, 0.01, "N");
}

TEST(SlowerSensor, OfTheOnlyOutputLosesNothingOfTheCommandBetween) {
  HiddenMachine machine;
  machine.reads_position_every = 5;
  HiddenAxis axis(machine);
  const WantedMotion motion = there_and_back(0.15, 0.4);
  expect_friction_and_cogging(
      diagnose(axis.diagram(), {axis.record("record", with_friction_and_cogging(axis), motion)}));
  const Diagnosis right = diagnose(axis.diagram(), {axis.record("right", axis.nominal(), motion)});
  EXPECT_EQ(right.verdict, Verdict::nothing_missing) << to_text(right);
}

TEST(SlowerSensor, BesideAFasterOneIsLeftOutOfAnAxis) {
  HiddenMachine machine;
  machine.velocity_noise = 2e-4, machine.reads_velocity_every = 10;
  HiddenAxis axis(machine);
  const Diagnosis d = diagnose(
      axis.diagram(), {axis.record("record", with_friction_and_cogging(axis), there_and_back(0.15, 0.4))});
  expect_friction_and_cogging(d);
  EXPECT_EQ(d.measurement_noise.size(), 1u);
  EXPECT_THAT(to_text(d), HasSubstr("the velocity is read less often"));
}

TEST(SlowerSensor, PositionBesideAFasterVelocityIsLeftOut) {
  HiddenMachine machine;
  machine.velocity_noise = 2e-4, machine.reads_position_every = 10;
  HiddenAxis axis(machine);
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.15;
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, there_and_back(0.15, 0.4))});
  ASSERT_THAT(names(d), ElementsAre("coulomb_friction")) << to_text(d);
  EXPECT_THAT(to_text(d), HasSubstr("the position is read less often"));
}

TEST(SlowerSensor, OfOneRecordAloneIsRefusedBesideOthers) {
  HiddenMachine machine;
  machine.velocity_noise = 2e-4, machine.reads_velocity_every = 10;
  HiddenAxis slow(machine);
  const std::string first = slow.record("slow", slow.nominal(), there_and_back(0.15, 0.4));
  machine.reads_velocity_every = 1;
  HiddenAxis fast(machine);
  const std::string second = fast.record("fast", fast.nominal(), there_and_back(0.12, 0.3));
  try {
    diagnose(slow.diagram(), {first, second});
    FAIL() << "one noise of the velocity would count in both";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the records do not measure the same of the axis"));
    EXPECT_THAT(error.what(), HasSubstr("found: position and velocity"));
  }
}

TEST(SlowerSensor, ShowsTheMissingForceAtItsOwnRate) {
  HiddenMachine machine;
  machine.reads_position_every = 5;
  HiddenAxis axis(machine);
  Physics truth = axis.nominal();
  const WantedMotion motion = there_and_back(0.15, 0.4);
  const Comparison right = compare(axis.diagram(), axis.record("right", truth, motion));
  ASSERT_TRUE(right.force) << right.why_no_force;
  EXPECT_NEAR(right.force->motion.sample_time, 5e-3, 1e-12);
  EXPECT_LT(right.force->residual.rmse, 0.03);
  EXPECT_EQ(right.signals[0].error.size(), (right.time.size() + 4) / 5);
  truth.coulomb_n = 0.3;
  const Comparison wrong = compare(axis.diagram(), axis.record("wrong", truth, motion));
  ASSERT_TRUE(wrong.force) << wrong.why_no_force;
  EXPECT_NEAR(wrong.force->residual.rmse, 0.3, 0.06);
}

TEST(SlowerSensor, OfAnyDiagramCountsWhereItIsRead) {
  Plant clean = motor({}, 1);
  clean.reads_every = {1, 10};
  const Diagnosis right = diagnosed(clean);
  EXPECT_EQ(right.verdict, Verdict::nothing_missing) << to_text(right);
  Motor m;
  m.resistance = 1.5;
  Plant plant = motor(m, 2);
  plant.reads_every = {10, 1};
  const Diagnosis d = diagnosed(plant);
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
  ASSERT_EQ(d.moved_parameters.size(), 1u) << to_text(d);
  EXPECT_EQ(d.moved_parameters.front().name, "resistance");
  EXPECT_NEAR(d.moved_parameters.front().value, 1.5, 0.03);
}

bool is_looked_for(const Diagnosis& d, const std::string& effect) {
  return std::ranges::none_of(d.not_looked_for, [&](const NotLookedFor& entry) {
    return std::ranges::find(entry.effects, effect) != entry.effects.end();
  });
}

/// A controller that sees every row answers noise before the record shows it, which looks like a delay.
TEST(SlowerSensorThanTheController, ShowsNoDelays) {
  HiddenMachine machine;
  machine.reads_position_every = 4, machine.force_noise = 0.2;
  HiddenAxis axis(machine);
  const WantedMotion motion = there_and_back(0.15, 0.4);
  const Diagnosis right = diagnose(axis.diagram(), {axis.record("right", axis.nominal(), motion)});
  EXPECT_EQ(right.verdict, Verdict::nothing_missing) << to_text(right);
  EXPECT_FALSE(is_looked_for(right, "input_delay")) << to_text(right);
  EXPECT_FALSE(is_looked_for(right, "actuator_lag")) << to_text(right);
  EXPECT_TRUE(is_looked_for(right, "coulomb_friction")) << to_text(right);
}

TEST(SlowerSensorThanTheController, ThatIsLeftOutShowsNoDelays) {
  HiddenMachine machine;
  machine.velocity_noise = 2e-3, machine.reads_position_every = 4, machine.force_noise = 0.2;
  HiddenAxis axis(machine);
  const Diagnosis right =
      diagnose(axis.diagram(), {axis.record("right", axis.nominal(), there_and_back(0.15, 0.4))});
  EXPECT_EQ(right.verdict, Verdict::nothing_missing) << to_text(right);
  EXPECT_FALSE(is_looked_for(right, "input_delay")) << to_text(right);
}

/// A command that changes with the readings alone hides nothing.
TEST(SlowerSensor, BesideACommandOfItsOwnRateShowsALag) {
  FlawedMachine machine;
  machine.lag = 8e-3, machine.sample_time = 4e-3, machine.holding_rows = 3;
  const FlawedAxis axis(machine);
  const Diagnosis d = diagnose(axis.diagram(), {axis.experiment()});
  EXPECT_TRUE(is_looked_for(d, "actuator_lag")) << to_text(d);
  EXPECT_THAT(names(d), ElementsAre(testing::AnyOf("actuator_lag", "input_delay"))) << to_text(d);
}

/// 4 kHz for more than two minutes: means of rows stand for them. Single readings let the answer of the
/// controller, which reads them all, appear as a delay of 3 ms.
TEST(LongRecord, MakesNoDelayOfTheAnswerToNoise) {
  FlawedMachine machine;
  machine.sample_time = 0.25e-3, machine.force_noise = 0.02, machine.duration = 130, machine.seed = 2;
  const FlawedAxis axis(machine);
  const Diagnosis d = diagnose(axis.diagram(), {axis.experiment()});
  EXPECT_EQ(name_of(d.verdict), "nothing_missing") << to_text(d);
}

/// Means of two rows: what a reading errs shows in one of them.
TEST(LongRecord, SeesTheNoiseOfAReadingOnce) {
  FlawedMachine machine;
  machine.sample_time = 50e-6, machine.duration = 8, machine.sensor_noise = 2e-7;
  const FlawedAxis axis(machine);
  const Diagnosis d = diagnose(axis.diagram(), {axis.experiment()});
  EXPECT_EQ(name_of(d.verdict), "nothing_missing") << to_text(d);
}

TEST(LongRecord, BesideAShortOneGivesItItsRate) {
  FlawedMachine machine;
  machine.sample_time = 0.25e-3, machine.force_noise = 0.02, machine.duration = 70, machine.coulomb = 0.2;
  const std::string folder = testing::TempDir() + fmt::format("long_{}", getpid());
  const FlawedAxis whole(machine, folder + "_whole");
  machine.duration = 20, machine.seed = 2;
  const FlawedAxis part(machine, folder + "_part");
  const Diagnosis d = diagnose(whole.diagram(), {part.experiment(), whole.experiment()});
  EXPECT_EQ(name_of(d.verdict), "explained") << to_text(d);
  ASSERT_THAT(names(d), ElementsAre("coulomb_friction")) << to_text(d);
  expect_parameter(d.effects[0], "level", 0.2, 0.01, "N");
}

TEST(RecordsOfTwoRates, AreRefused) {
  FlawedMachine machine;
  machine.duration = 5;
  const std::string folder = testing::TempDir() + fmt::format("two_rates_{}", getpid());
  const FlawedAxis slow(machine, folder + "_slow");
  machine.sample_time *= 0.7;
  const FlawedAxis fast(machine, folder + "_fast");
  try {
    diagnose(slow.diagram(), {slow.experiment(), fast.experiment()});
    FAIL() << "one noise of a sample would count in both";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the records have different rates"));
    EXPECT_THAT(error.what(), HasSubstr("found: 0.0007 s"));
  }
}

}  // namespace
}  // namespace loopwright::several_rates_test
