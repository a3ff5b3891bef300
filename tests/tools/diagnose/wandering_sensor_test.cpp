// A sensor whose offset wanders is told from a load that moves by itself.
#include "tools/diagnose/search/wandering_sensor.h"
#include <gmock/gmock.h>
#include "tests/tools/diagnose/flawed_axis.h"
#include "tools/diagnose/diagnose.h"
#include "tools/diagnose/search/prepare.h"

namespace loopwright::wandering_sensor_test {
namespace {

using namespace diagnosis;

FlawedMachine machine(double wander, uint64_t seed) {
  FlawedMachine m;
  m.seed = seed, m.sensor_noise = 1e-6, m.resolution = 0, m.wander = wander;
  return m;
}

/// Beside the nominal diagram.
WanderingSensor found_with(const FlawedMachine& m) {
  const FlawedAxis axis(m);
  diagnosis::Motion motion;
  Trials trials = prepare(axis.diagram(), {axis.experiment()}, {}, motion);
  const Estimate nominal =
      with_own_noise(trials, fit_members(trials, {}, search_noise(trials), motion, 0), 0);
  const auto found = wandering_sensor(trials, nominal);
  EXPECT_TRUE(found);
  return found.value_or(WanderingSensor{});
}

TEST(WanderingSensor, SizeAndTimeAreFound) {
  const WanderingSensor found = found_with(machine(60e-6, 3));
  EXPECT_NEAR(found.size, 60e-6, 30e-6);
  EXPECT_GT(found.time_s, 0.5);
  EXPECT_LT(found.time_s, 8);
  EXPECT_GT(found.gain, 200);
}
TEST(WanderingSensor, AnOffsetThatStaysGainsNothing) { EXPECT_LT(found_with(machine(0, 4)).gain, 10); }

bool names_a_load(const Diagnosis& d) {
  return std::ranges::any_of(d.effects, [](const DiagnosedEffect& e) {
    return e.name == "backlash" || e.name == "flexible_mode" || e.name == "end_stop";
  });
}

/// A load would follow such an offset, and take it for its own motion.
TEST(WanderingSensor, IsNoLoadThatExplains) {
  for (uint64_t seed = 5; seed < 9; ++seed) {
    const FlawedAxis axis(machine(80e-6, seed));
    const Diagnosis d = diagnose(axis.diagram(), {axis.experiment()});
    EXPECT_FALSE(names_a_load(d) && d.verdict == Verdict::explained) << seed << "\n" << to_text(d);
  }
}
/// The other way round: a load is none of a sensor.
TEST(WanderingSensor, ALoadStaysALoad) {
  FlawedMachine m;
  m.seed = 9, m.load_mass = 0.15, m.load_hz = 25;
  const FlawedAxis axis(m);
  const Diagnosis d = diagnose(axis.diagram(), {axis.experiment()});
  EXPECT_EQ(name_of(d.verdict), "explained") << to_text(d);
  EXPECT_TRUE(names_a_load(d)) << to_text(d);
}

}  // namespace
}  // namespace loopwright::wandering_sensor_test
