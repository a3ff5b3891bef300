#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"

namespace loopwright {
namespace {

using ::testing::Contains;

/// Without damping a gain and a mass are the same thing; both fit to 1e-5 of the criterion.
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

}  // namespace
}  // namespace loopwright
