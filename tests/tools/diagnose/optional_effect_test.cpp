// Which effects the written diagram needs.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"

namespace loopwright::optional_effect_test {
namespace {

/// A ripple that is small beside the friction, but several times the noise.
TEST(OptionalEffect, IsNoneThatLeavesTwiceTheErrorOfAll) {
  HiddenMachine machine;
  machine.mass = 0.8, machine.damping = 4, machine.force_noise = 0.02, machine.encoder_noise = 1e-6;
  HiddenAxis axis(machine);
  Physics truth = axis.nominal();
  truth.coulomb_n = 4, truth.cogging = {0.15, 0.02, 0};
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("both", truth, there_and_back(0.2, 0.4))});
  ASSERT_THAT(names(d), testing::UnorderedElementsAre("coulomb_friction", "cogging")) << to_text(d);
  ASSERT_EQ(d.steps.size(), 3u);
  EXPECT_GT(d.steps[1].force_rmse, 2 * d.steps[2].force_rmse) << to_text(d);
  EXPECT_LT(d.steps[1].force_rmse - d.steps[2].force_rmse, 0.05 * d.steps[0].force_rmse) << to_text(d);
  for (const DiagnosedEffect& effect : d.effects) EXPECT_FALSE(effect.is_optional) << effect.name;
}

}  // namespace
}  // namespace loopwright::optional_effect_test
