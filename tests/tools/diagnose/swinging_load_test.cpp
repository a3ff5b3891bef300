// A load on a spring that the first rows of a record set in motion.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"

namespace loopwright::swinging_load_test {
namespace {

constexpr double mass = 0.8, load = 0.3, hz = 11.86, damping_ratio = 0.0237;

/// The command leaps in the first row, so that the load swings for a second.
Diagnosis of_record_that_begins_with_a_push() {
  HiddenMachine machine;
  machine.mass = mass, machine.damping = 4, machine.force_noise = 0.02, machine.encoder_noise = 1e-6;
  HiddenAxis axis(machine);
  Physics truth = axis.nominal();
  const double w = 2 * std::numbers::pi * hz;
  truth.load_kg = load, truth.gap_m = -1, truth.coupling_n_per_m = load * w * w;
  truth.coupling_n_s_per_m = 2 * damping_ratio * load * w;
  WantedMotion motion = there_and_back(0.2, 0.4);
  const WantedMotion more = motion;
  motion.position.insert(motion.position.end(), more.position.begin(), more.position.end());
  motion.added_force.assign(motion.position.size(), 0.0);
  for (size_t k = 0; k < 12; ++k) motion.added_force[k] = 10;
  return diagnose(axis.diagram(), {axis.record("push", truth, motion)});
}

/// What the nominal diagram estimates of the first motion is wrong, and would bend the damping to a half.
TEST(SwingingLoad, HasItsNumbersThoughTheRecordBeginsWithAPush) {
  const Diagnosis d = of_record_that_begins_with_a_push();
  ASSERT_THAT(names(d), testing::ElementsAre("flexible_mode")) << to_text(d);
  EXPECT_EQ(name_of(d.verdict), "explained") << to_text(d);
  expect_parameter(d.effects[0], "load_mass", load, 0.006, "N*s^2/m");
  expect_parameter(d.effects[0], "frequency", hz, 0.03, "Hz");
  expect_parameter(d.effects[0], "damping_ratio", damping_ratio, 0.003, "1");
}

}  // namespace
}  // namespace loopwright::swinging_load_test
