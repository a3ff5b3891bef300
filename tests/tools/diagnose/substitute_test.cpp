#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"

namespace loopwright::substitute_test {
namespace {

using ::testing::Contains;
using ::testing::UnorderedElementsAre;

/// Without damping a gain and a mass are equivalent. Both fit to 1e-5 of the criterion.
TEST(Substitute, WithoutDampingAGainAndAMassAreDeclaredAlike) {
  HiddenMachine machine;
  machine.damping = 0;
  HiddenAxis axis(machine);
  Physics truth = axis.nominal();
  truth.added_mass_kg = 0.05;
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("one", truth, there_and_back(0.15, 0.4))});
  ASSERT_EQ(d.effects.size(), 1u) << to_text(d);
  if (d.effects[0].name != "inertia") {
    EXPECT_THAT(d.effects[0].alternatives, Contains("inertia")) << to_text(d);
  }
}

/// (M + m) a + (B + b) v = u is also a law with the diagram's own mass, another damping and a gain.
TEST(Substitute, MassAndDampingAreSaidRatherThanAGainWhichIsDeclared) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.added_mass_kg = 0.1, truth.damping_n_s_per_m += 1.5;
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("both", truth, there_and_back(0.15, 0.4))});
  ASSERT_THAT(names(d), UnorderedElementsAre("inertia", "viscous_friction")) << to_text(d);
  for (const DiagnosedEffect& effect : d.effects)
    EXPECT_THAT(effect.alternatives, Contains("force_gain")) << to_text(d);
}

}  // namespace
}  // namespace loopwright::substitute_test
