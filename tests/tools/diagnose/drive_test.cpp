// What becomes of a command on its way to the machine, and what a measured input shows that the machine does
// not feel.
#include <gmock/gmock.h>
#include <cmath>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"
#include "tools/diagnose/diagnose.h"

namespace loopwright::drive_test {
namespace {

using testing::ElementsAre, testing::HasSubstr;

Diagnosis diagnosed(HiddenAxis& axis, const WantedMotion& motion) {
  return diagnose(axis.diagram(), {axis.record("record", axis.nominal(), motion)});
}
double value_of(const DiagnosedEffect& effect, const std::string& name) {
  for (const DiagnosedParameter& p : effect.parameters)
    if (p.name == name) return p.value;
  return std::nan("");
}
void expect_explained_by(const Diagnosis& d, const char* effect) {
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
  ASSERT_THAT(names(d), ElementsAre(effect)) << to_text(d);
}
WantedMotion brisk() { return there_and_back(0.2, 0.6).stroke(0.2, 0.5, 0.08).stroke(-0.2, 0.5, 0.08); }

TEST(Drive, AnAmplifierThatLimitsItsCurrentIsNamedWithItsLimit) {
  HiddenMachine machine;
  machine.has_controller = false;
  machine.drive = [](double command, double) { return std::clamp(command, -1.5, 1.5); };
  HiddenAxis axis(machine);
  const Diagnosis d = diagnosed(axis, brisk());
  ASSERT_NO_FATAL_FAILURE(expect_explained_by(d, "force_saturation"));
  EXPECT_EQ(d.effects[0].form, "amplifier");
  EXPECT_NEAR(value_of(d.effects[0], "limit"), 1.5, 0.02);
  EXPECT_NEAR(value_of(d.effects[0], "loss"), 1, 0.02);
  EXPECT_FALSE(d.effects[0].is_optional);
}

/// It was told as that of iron with a drift.
TEST(Drive, AMotorThatSaturatesSoftlyIsNamedWithItsLimit) {
  HiddenMachine machine;
  machine.drive = [](double command, double) { return 4 * std::tanh(command / 4); };
  HiddenAxis axis(machine);
  const Diagnosis d = diagnosed(axis, brisk());
  ASSERT_NO_FATAL_FAILURE(expect_explained_by(d, "force_saturation"));
  EXPECT_EQ(d.effects[0].form, "soft");
  EXPECT_NEAR(value_of(d.effects[0], "limit"), 4, 0.4);
}

/// It was told as a gain that differs with the direction and drag: taken for motion, its error has an
/// acceleration.
TEST(Drive, APositionSensorThatIsNotLinearIsNamed) {
  HiddenMachine machine;
  machine.sensor = [](double x) { return x + 0.3 * (x - 0.1) * (x - 0.1); };  // 3 mm at the ends of 0.2 m
  HiddenAxis axis(machine);
  const Diagnosis d = diagnosed(axis, there_and_back(0.2, 0.6));
  ASSERT_NO_FATAL_FAILURE(expect_explained_by(d, "sensor_nonlinearity"));
  EXPECT_NEAR(value_of(d.effects[0], "curvature"), 0.3, 0.009) << to_text(d);
}

TEST(Drive, ADeadBandOfAnAmplifierIsNamedWithItsWidth) {
  HiddenMachine machine;
  machine.drive = [](double command, double) {
    return std::copysign(std::max(0.0, std::abs(command) - 0.1), command);
  };
  HiddenAxis axis(machine);
  const Diagnosis d = diagnosed(axis, brisk());
  ASSERT_NO_FATAL_FAILURE(expect_explained_by(d, "dead_band"));
  EXPECT_NEAR(value_of(d.effects[0], "width"), 0.1, 0.005);
}

/// A half bridge, a valve: 5 % more one way, 5 % less the other, behind noise that hid it as a spring.
TEST(Drive, AGainThatDiffersWithTheSignOfTheCommandIsNamed) {
  HiddenMachine machine;
  machine.drive = [](double command, double) { return command + 0.05 * std::abs(command); };
  HiddenAxis axis(machine);
  const std::string experiment = axis.record("record", axis.nominal(), brisk());
  DiagnoseOptions options;
  options.improved_diagram = axis.file("improved.json");
  const Diagnosis d = diagnose(axis.diagram(), {experiment}, options);
  ASSERT_NO_FATAL_FAILURE(expect_explained_by(d, "asymmetric_gain"));
  EXPECT_NEAR(value_of(d.effects[0], "asymmetry"), 0.05, 0.003);
  const Diagnosis after =
      diagnose(d.improved, d.improved_experiments.empty() ? std::vector{experiment} : d.improved_experiments);
  EXPECT_EQ(after.verdict, Verdict::nothing_missing) << to_text(after);
}

/// A force sensor of the drive: its noise is averaged by a lag, which looked like one of the machine.
TEST(Drive, NoiseOfAMeasuredInputIsNoLag) {
  HiddenMachine machine;
  machine.unfelt_noise = 0.1, machine.force_noise = 0.1;
  HiddenAxis axis(machine);
  const Diagnosis d = diagnosed(axis, there_and_back(0.3, 0.3));
  EXPECT_EQ(d.verdict, Verdict::nothing_missing) << to_text(d);
}

/// The bridge is off for the first strokes of the controller: the axis rests although its command pushes it.
TEST(Drive, ACommandThatDoesNotArriveIsNoNoise) {
  HiddenMachine machine;
  machine.drive = [](double command, double t) { return t < 0.9 ? 0.0 : command; };
  HiddenAxis axis(machine);
  const Diagnosis d = diagnosed(axis, there_and_back(0.2, 0.4));
  EXPECT_EQ(d.verdict, Verdict::unexplained) << to_text(d);
  ASSERT_TRUE(d.remainder_interval) << to_text(d);
  EXPECT_LT(d.remainder_interval->to_s, 1.1);
}

/// Somebody pushes the axis for a third of a second.
TEST(Drive, APushIsToldWithItsTime) {
  HiddenMachine machine;
  machine.drive = [](double command, double t) { return t > 3 && t < 3.3 ? command + 1 : command; };
  HiddenAxis axis(machine);
  const Diagnosis d = diagnosed(axis, there_and_back(0.3, 0.3));
  EXPECT_NE(d.verdict, Verdict::nothing_missing);
  EXPECT_NE(d.verdict, Verdict::explained);
  ASSERT_TRUE(d.remainder_interval) << to_text(d);
  EXPECT_GT(d.remainder_interval->from_s, 2.95);  // the shortest time with four fifths of the errors
  EXPECT_LT(d.remainder_interval->to_s, 3.35);
  EXPECT_THAT(to_text(d), HasSubstr("Most of what is left occurs between"));
}

}  // namespace
}  // namespace loopwright::drive_test
