// A weight that the input holds is most of its force, and no measure of what is small.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"

namespace loopwright::held_weight_test {
namespace {

using testing::Contains;

/// Friction of a twelfth of what the motion needs, and of four thousandths of the force of the motor.
TEST(HeldWeight, DoesNotHideFrictionThatMattersToTheMotion) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.offset_n = -25, truth.coulomb_n = 0.1;
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("weight", truth, there_and_back(0.25, 0.4))});
  EXPECT_THAT(names(d), Contains("constant_force")) << to_text(d);
  EXPECT_THAT(names(d), Contains("coulomb_friction")) << to_text(d);
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
}

}  // namespace
}  // namespace loopwright::held_weight_test
