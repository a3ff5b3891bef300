// An error of the encoder that repeats a few times along the stroke, as that of a scale that is mounted
// askew.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed_axis.h"

namespace loopwright::encoder_error_test {
namespace {

using testing::ElementsAre;

/// It had been told as cogging that changes with speed.
TEST(EncoderError, OfAThirdOfTheStrokeIsNamedWithFewRowsBetweenTurns) {
  FlawedMachine machine;
  machine.encoder_error = 4e-6, machine.encoder_pitch = 0.1;
  machine.oscillation_hz = 2, machine.stroke = 0.3, machine.sample_time = 0.01, machine.duration = 40;
  machine.controller_hz = 3, machine.force_noise = 0.03, machine.sensor_noise = 3e-8,
  machine.resolution = 1e-7;
  const Diagnosis d = diagnosed(machine);
  ASSERT_THAT(names(d), ElementsAre("encoder_periodic_error")) << to_text(d);
  EXPECT_EQ(name_of(d.verdict), "explained") << to_text(d);
  expect_parameter(d.effects[0], "pitch", 0.1, 0.02, "m");
}

}  // namespace
}  // namespace loopwright::encoder_error_test
