// A lag of a part of a sample: too small to matter, but said. The answer of a controller to noise,
// which resembles one, is not.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed_axis.h"

namespace loopwright::small_delay_test {
namespace {

std::vector<std::string> small_effects(const Diagnosis& d) {
  std::vector<std::string> list;
  for (const TooSmallEffect& effect : d.too_small) list.push_back(effect.effect);
  return list;
}

FlawedMachine machine_of(uint64_t seed) {
  FlawedMachine machine;
  machine.input_is_linear = true, machine.seed = seed;
  return machine;
}

TEST(SmallDelay, IsSaid) {
  size_t small = 0;
  for (uint64_t seed : {1, 2, 3, 4}) {
    FlawedMachine machine = machine_of(seed);
    machine.lag = 6e-4, machine.damping = 20;
    const Diagnosis d = diagnosed(machine);
    std::vector<std::string> said = small_effects(d);
    small += said.size();
    std::ranges::copy(names(d), std::back_inserter(said));
    EXPECT_THAT(said, testing::Contains(testing::AnyOf("input_delay", "actuator_lag"))) << seed << to_text(d);
  }
  EXPECT_GT(small, 0u) << "all of them matter";
}

TEST(SmallDelay, IsNoAnswerOfAControllerToNoise) {
  for (uint64_t seed : {1, 2, 3})
    for (const double velocity_noise : {0.0, 4e-4}) {
      FlawedMachine machine = machine_of(seed);
      machine.velocity_noise = velocity_noise;
      const Diagnosis d = diagnosed(machine);
      EXPECT_EQ(name_of(d.verdict), "nothing_missing") << to_text(d);
      EXPECT_THAT(small_effects(d), testing::IsEmpty()) << to_text(d);
    }
}

}  // namespace
}  // namespace loopwright::small_delay_test
