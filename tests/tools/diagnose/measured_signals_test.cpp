// Measured signals: velocity instead of position, both, the angle of a rotary axis, the counts of an encoder.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"

namespace loopwright::measured_signals_test {
namespace {

using testing::ElementsAre;

HiddenMachine with_velocity(bool position) {
  HiddenMachine machine;
  machine.velocity_noise = 2e-4, machine.measures_position = position;
  return machine;
}

TEST(MeasuredVelocity, IsEnoughToFindFriction) {
  HiddenAxis axis(with_velocity(false));
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.15;
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, there_and_back(0.15, 0.4))});
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
  ASSERT_THAT(names(d), ElementsAre("coulomb_friction")) << to_text(d);
  expect_parameter(d.effects[0], "level", 0.15, 0.01, "N");
  EXPECT_EQ(d.measured_unit, "m/s");
  ASSERT_EQ(d.measurement_noise.size(), 1u);
  EXPECT_NEAR(d.measurement_noise[0], 2e-4, 2e-5);
}

TEST(MeasuredVelocity, IsEnoughToFindMassAndToFindNothing) {
  HiddenAxis axis(with_velocity(false));
  const WantedMotion motion = there_and_back(0.15, 0.4);
  Physics truth = axis.nominal();
  truth.added_mass_kg = 0.05;
  const Diagnosis heavy = diagnose(axis.diagram(), {axis.record("heavy", truth, motion)});
  ASSERT_THAT(names(heavy), ElementsAre("inertia")) << to_text(heavy);
  expect_parameter(heavy.effects[0], "mass", 0.05, 0.005, "N*s^2/m");
  const Diagnosis right = diagnose(axis.diagram(), {axis.record("right", axis.nominal(), motion)});
  EXPECT_EQ(right.verdict, Verdict::nothing_missing) << to_text(right);
}

/// The controller measures the position, the record the velocity alone: which shape a late input has is not
/// certain.
TEST(MeasuredVelocity, DeclaresALagBesideADelay) {
  HiddenMachine machine = with_velocity(false);
  machine.velocity_noise = 2e-3;
  HiddenAxis axis(machine);
  Physics truth = axis.nominal();
  truth.lag_s = 2.2e-3;
  WantedMotion motion;
  motion.rest(0.2);
  for (int stroke = 0; stroke < 100; ++stroke)
    motion.stroke(stroke % 2 == 0 ? 0.15 : -0.15, 0.2 + 0.004 * stroke, 0.06).rest(0.05);
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, motion)});
  ASSERT_EQ(d.effects.size(), 1u) << to_text(d);
  std::vector<std::string> told = d.effects[0].alternatives;
  told.push_back(d.effects[0].name);
  EXPECT_THAT(told, testing::UnorderedElementsAre("actuator_lag", "input_delay")) << to_text(d);
}

TEST(MeasuredVelocity, FindsCoggingBesidePosition) {
  HiddenAxis axis(with_velocity(true));
  Physics truth = axis.nominal();
  truth.cogging = {0.1, 0.0225, 0.5};
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, there_and_back(0.15, 0.4))});
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
  ASSERT_THAT(names(d), ElementsAre("cogging")) << to_text(d);
  expect_parameter(d.effects[0], "pitch", 0.0225, 1e-4, "m");
  ASSERT_EQ(d.measurement_noise.size(), 2u);
  EXPECT_NEAR(d.measurement_noise[1], 2e-4, 2e-5) << "position first";
}

/// A rotor of 2 g m² with 17 bits a turn.
HiddenMachine rotor(const std::string& force_unit) {
  HiddenMachine machine;
  machine.mass = 2e-3, machine.damping = 5e-3;
  machine.position_unit = "rad", machine.force_unit = force_unit;
  machine.force_noise = 5e-4, machine.encoder_noise = 1e-5;
  machine.resolution = 2 * std::numbers::pi / 131072;
  return machine;
}

TEST(RotaryAxis, FrictionIsANewtonMetreAndDampingANewtonMetrePerRadianPerSecond) {
  HiddenAxis axis(rotor("N*m"));
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.02, truth.added_damping_n_s_per_m = 4e-3;
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, there_and_back(6, 15))});
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
  ASSERT_THAT(names(d), testing::UnorderedElementsAre("coulomb_friction", "viscous_friction")) << to_text(d);
  const bool coulomb_first = d.effects[0].name == "coulomb_friction";
  expect_parameter(d.effects[coulomb_first ? 0 : 1], "level", 0.02, 0.002, "N*m");
  expect_parameter(d.effects[coulomb_first ? 1 : 0], "damping", 4e-3, 4e-4, "N*m*s/rad");
  EXPECT_EQ(d.force_unit, "N*m");
  EXPECT_EQ(d.position_unit, "rad");
}

TEST(RotaryAxis, ADiskIsAMomentOfInertia) {
  HiddenAxis axis(rotor("N*m"));
  Physics truth = axis.nominal();
  truth.added_mass_kg = 5e-4;
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, there_and_back(6, 15))});
  ASSERT_THAT(names(d), ElementsAre("inertia")) << to_text(d);
  expect_parameter(d.effects[0], "mass", 5e-4, 5e-5, "N*m*s^2/rad");
}

TEST(RotaryAxis, CoggingOfTwelveToATurnIsFoundInAmperes) {
  HiddenAxis axis(rotor("A"));
  Physics truth = axis.nominal();
  truth.cogging = {0.01, 2 * std::numbers::pi / 12, 1};
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, there_and_back(6, 15))});
  ASSERT_THAT(names(d), ElementsAre("cogging")) << to_text(d);
  const auto pitch = std::ranges::find(d.effects[0].parameters, "pitch", &DiagnosedParameter::name);
  ASSERT_NE(pitch, d.effects[0].parameters.end());
  EXPECT_EQ(pitch->times_a_turn, 12) << to_text(d);  // a whole number, and so without an interval
  EXPECT_DOUBLE_EQ(pitch->value, 2 * std::numbers::pi / 12);
  EXPECT_EQ(d.effects[0].parameters[1].unit, "A");
  EXPECT_EQ(d.force_unit, "A");
}

HiddenMachine with_encoder(const std::string& settings) {
  HiddenMachine machine;
  machine.position_port = "encoder.position";
  machine.further_blocks = fmt::format(
      R"("encoder":   {{"type": "Encoder", {}, "in": {{"position": "mass.position"}}}},)", settings);
  return machine;
}

class EncoderInTheDiagram : public testing::TestWithParam<const char*> {};

TEST_P(EncoderInTheDiagram, IsLookedBehind) {
  HiddenAxis axis(with_encoder(GetParam()));
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.15;
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, there_and_back(0.15, 0.4))});
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
  ASSERT_THAT(names(d), ElementsAre("coulomb_friction")) << to_text(d);
  expect_parameter(d.effects[0], "level", 0.15, 0.01, "N");
}

INSTANTIATE_TEST_SUITE_P(That, EncoderInTheDiagram,
                         testing::Values(R"("sample_time": 0.001, "resolution": 2e-7)",
                                         R"("sample_time": 0.001, "resolution": 0)", R"("resolution": 2e-7)",
                                         R"("resolution": 0)", R"("resolution": 0, "offset": 0.01)"));

TEST(SampledEncoder, LeavesCoggingInItsPlace) {
  HiddenAxis axis(with_encoder(R"("sample_time": 0.001, "resolution": 2e-7)"));
  Physics truth = axis.nominal();
  truth.cogging = {0.1, 0.0225, 0.5};
  DiagnoseOptions options;
  options.improved_diagram = axis.file("improved.json");
  const Diagnosis d =
      diagnose(axis.diagram(), {axis.record("record", truth, there_and_back(0.15, 0.4))}, options);
  ASSERT_THAT(names(d), ElementsAre("cogging")) << to_text(d);
  expect_parameter(d.effects[0], "pitch", 0.0225, 1e-4, "m");
  Problems problems;
  EXPECT_TRUE(load_diagram(d.improved, {}, problems)) << problems.text();
}

}  // namespace
}  // namespace loopwright::measured_signals_test
