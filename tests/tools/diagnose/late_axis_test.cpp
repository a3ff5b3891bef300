// A command that gets to an axis late, beside a controller that answers to the noise of the sensor: that
// answer resembles a delay in the errors, and hides a true one in a simulation by what the controller
// commanded.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed_axis.h"

namespace loopwright::late_axis_test {
namespace {

FlawedMachine with_counts_of(double metres) {
  FlawedMachine machine;
  machine.resolution = metres, machine.sensor_noise = metres / 3;
  machine.damping = 3, machine.added_damping = 1;
  return machine;
}

/// The diagram with the lag simulates up to a fifth worse, and the balance of the forces up to 80 Hz speaks
/// against it; the slow one does not.
TEST(LateAxis, IsToldBesideCoarseCounts) {
  for (const double count : {2e-5, 5e-5, 2e-4})
    for (const double lag : {2e-3, 4e-3}) {
      FlawedMachine machine = with_counts_of(count);
      machine.lag = lag;
      const Diagnosis d = diagnosed(machine);
      EXPECT_THAT(names(d), testing::UnorderedElementsAre("viscous_friction", "actuator_lag"))
          << count << " " << lag << "\n"
          << to_text(d);
      EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
    }
}

TEST(LateAxis, IsNotInvented) {
  for (const double count : {2e-5, 2e-4}) {
    const Diagnosis d = diagnosed(with_counts_of(count));
    EXPECT_EQ(names(d), std::vector<std::string>{"viscous_friction"}) << to_text(d);
  }
}

/// A fast controller answers to every count. Noise that is fitted beside a delay may seem smaller and slower
/// than it is, and the delay certain; without the delay it is as it is, and does better.
TEST(LateAxis, IsNotInventedUnderAFastController) {
  for (const uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    FlawedMachine machine;
    machine.mass = 1.2, machine.damping = 4, machine.force_noise = 0.05, machine.controller_hz = 40;
    machine.duration = 6.6, machine.stroke = 0.1, machine.top_speed = 0.3, machine.seed = seed;
    const Diagnosis d = diagnosed(machine);
    EXPECT_EQ(name_of(d.verdict), "nothing_missing") << "seed " << seed << "\n" << to_text(d);
  }
}

/// Fifty rows: a range in rows alone would end before.
TEST(LateAxis, MayBeLateByManyRowsOfAFastRecord) {
  FlawedMachine machine;
  machine.sample_time = 5e-5, machine.duration = 2, machine.lag = 2.5e-3, machine.top_speed = 1;
  const Diagnosis d = diagnosed(machine);
  ASSERT_EQ(d.effects.size(), 1u) << to_text(d);
  std::vector<std::string> said = d.effects[0].alternatives;
  said.push_back(d.effects[0].name);
  EXPECT_THAT(said, testing::Contains("actuator_lag")) << "or a delay, if it is said that the two are alike";
  EXPECT_NEAR(d.effects[0].parameters[0].value, 2.5e-3, 1e-4) << to_text(d);
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
}

}  // namespace
}  // namespace loopwright::late_axis_test
