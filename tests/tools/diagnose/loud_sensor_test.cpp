// A controller answers to the noise of its sensor, and the recorded command is full of it; an encoder slips.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"

namespace loopwright::loud_sensor_test {
namespace {

/// Strokes, repeated.
WantedMotion strokes(int times) {
  const WantedMotion once = there_and_back(0.15, 0.4);
  WantedMotion motion;
  for (int i = 0; i < times; ++i)
    motion.position.insert(motion.position.end(), once.position.begin(), once.position.end());
  return motion;
}

HiddenMachine machine_with(double encoder_noise) {
  HiddenMachine machine;
  machine.mass = 2, machine.damping = 5, machine.force_noise = 0.05, machine.encoder_noise = encoder_noise;
  return machine;
}

Diagnosis of_loud_sensor(double gain) {
  HiddenAxis axis(machine_with(1e-4));
  Physics truth = axis.nominal();
  truth.gain = gain;
  return diagnose(axis.diagram(), {axis.record("loud", truth, strokes(2))});
}

/// Along the measured motion the balance of the forces shows nothing but that noise.
TEST(LoudSensor, AGainIsFoundThoughTheBalanceOfForcesIsLostInNoise) {
  const Diagnosis d = of_loud_sensor(-0.15);
  ASSERT_THAT(names(d), testing::ElementsAre("force_gain")) << to_text(d);
  EXPECT_EQ(name_of(d.verdict), "explained") << to_text(d);
  expect_parameter(d.effects[0], "gain_error", -0.15, 0.05, "1");
}

TEST(LoudSensor, IsNoEffect) {
  const Diagnosis d = of_loud_sensor(0);
  EXPECT_EQ(name_of(d.verdict), "nothing_missing") << to_text(d);
}

/// The predictor follows a leap of the readings within a few rows, and its errors are white again. The force
/// that would have moved the axis so far is left.
TEST(LoudSensor, AnEncoderThatSlipsIsNotCalledNothing) {
  HiddenMachine machine = machine_with(2e-6);
  size_t readings = 0;
  machine.sensor = [&](double position) { return position + (++readings > 3000 ? 2e-3 : 0); };
  HiddenAxis axis(machine);
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("slip", axis.nominal(), strokes(4))});
  EXPECT_EQ(name_of(d.verdict), "unexplained") << to_text(d);
  EXPECT_THAT(d.contradictions,
              testing::Contains(testing::HasSubstr("times what the estimated noise leaves")));
}

}  // namespace
}  // namespace loopwright::loud_sensor_test
