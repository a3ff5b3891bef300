// What the fitted noise of the force would swallow: a law that the catalogue lacks, behind coarse counts.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed_axis.h"

namespace loopwright::hidden_in_noise_test {
namespace {

/// 670 counts a stroke, read at 2 kHz: force is seen only by its mean over many rows.
FlawedMachine behind_coarse_counts() {
  FlawedMachine machine;
  machine.sample_time = 5e-4, machine.resolution = 3e-4, machine.controller_hz = 2;
  machine.force_noise = 0.003;
  return machine;
}

TEST(HiddenInNoise, IsFrictionInAPartOfTheTravel) {
  FlawedMachine machine = behind_coarse_counts();
  machine.coulomb = 0.1, machine.coulomb_from = 0.1;
  const Diagnosis d = diagnosed(machine);
  EXPECT_THAT(d.verdict, testing::AnyOf(Verdict::unexplained, Verdict::partly_explained)) << to_text(d);
  EXPECT_THAT(d.remainder_variables, testing::Contains("direction")) << to_text(d);
}

TEST(HiddenInNoise, IsNothingWhereNothingIsMissing) {
  const Diagnosis d = diagnosed(behind_coarse_counts());
  EXPECT_EQ(name_of(d.verdict), "nothing_missing") << to_text(d);
}

}  // namespace
}  // namespace loopwright::hidden_in_noise_test
