// Flexure stages: a spring whose force is many times that of the motor, which drives it through its
// resonance.
#include <gmock/gmock.h>
#include <cmath>
#include <numbers>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"

namespace loopwright::resonant_spring_test {
namespace {

using testing::UnorderedElementsAre;

/// 12 s in open loop: a sine of 1 N from 1 to 9 Hz, or 1 N of a random sign.
WantedMotion pushed(bool at_random) {
  constexpr size_t rows = 12000, held = 70;
  WantedMotion motion;
  motion.position.assign(rows, 0);
  Random random = random_stream(5, "signs");
  double phase = 0, sign = 1;
  for (size_t k = 0; k < rows; ++k) {
    const double hertz = 1 + 8 * double(k) / double(rows);
    phase += 2 * std::numbers::pi * hertz * hidden_sample_time;
    if (k % held == 0) sign = random_normal(&random) < 0 ? -1 : 1;
    motion.added_force.push_back(at_random ? sign : std::sin(phase));
  }
  return motion;
}

class ResonantSpring : public testing::TestWithParam<bool> {};

/// It was called two end stops that meet.
TEST_P(ResonantSpring, IsOneSpring) {
  HiddenMachine machine;
  machine.damping = 0.3, machine.has_controller = false;
  HiddenAxis axis(machine);
  Physics truth = axis.nominal();
  truth.spring_n_per_m = 260;  // 5 Hz
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("record", truth, pushed(GetParam()))});
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
  ASSERT_THAT(names(d), UnorderedElementsAre("spring")) << to_text(d);
  expect_parameter(d.effects[0], "stiffness", 260, 1, "N/m");
}

INSTANTIATE_TEST_SUITE_P(Drives, ResonantSpring, testing::Values(false, true));

}  // namespace
}  // namespace loopwright::resonant_spring_test
