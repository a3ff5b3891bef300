/// An axis with such fast motion that it reverses within a sample: the moment is known to a sample or two,
/// and dry friction has the wrong sign for this time.
#include <gmock/gmock.h>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"

namespace loopwright::reversal_test {
namespace {

using testing::ElementsAre;

/// Slow strokes with six added sines, whose speed is several times that of the strokes.
WantedMotion shaken() {
  WantedMotion motion;
  motion.rest(0.3);
  for (double sign : {1.0, -1.0}) motion.stroke(sign * 0.5, 0.06, 0.3).rest(0.3);
  constexpr double frequencies_hz[] = {0.7, 1.3, 2.3, 3.7, 6.1, 10.3}, speed = 0.04, rise_s = 0.5;
  for (size_t k = 0; k < motion.position.size(); ++k) {
    const double t = double(k) * hidden_sample_time, share = std::min(1.0, t / rise_s);
    double sum = 0;
    for (double hz : frequencies_hz) {
      const double angular = 2 * std::numbers::pi * hz;
      sum += speed / angular * std::sin(angular * t + hz);
    }
    motion.position[k] += share * share * (3 - 2 * share) * sum;
  }
  return motion;
}

TEST(Reversal, WithinASampleLeavesStrongDryFrictionAlone) {
  HiddenAxis axis;
  Physics truth = axis.nominal();
  truth.coulomb_n = 0.4;
  const Diagnosis d = diagnose(axis.diagram(), {axis.record("shaken", truth, shaken())});
  EXPECT_EQ(d.verdict, Verdict::explained);
  ASSERT_THAT(names(d), ElementsAre("coulomb_friction")) << to_text(d);
  expect_parameter(d.effects[0], "level", 0.4, 0.01, "N");
  EXPECT_LT(d.mean_square, 1.05);
  EXPECT_LT(d.white_force, 1.1 * 0.01);  // none of the noise is friction at the wrong moment
}

}  // namespace
}  // namespace loopwright::reversal_test
