// Samples of a linear axis, computed without its run.
#include "tools/diagnose/predict/affine_sample.h"
#include <gtest/gtest.h>
#include <cmath>
#include "engine/run/run.h"
#include "tests/tools/diagnose/hidden_axis.h"
#include "tools/diagnose/predict/axis_model.h"

namespace loopwright::diagnosis::affine_sample_test {
namespace {

TEST(AffineSample, IsWhatASampleComesToAndTouchesNoOtherState) {
  const auto next = [](std::vector<double>& x, double u, double f) {
    x = {0.9 * x[0] - 0.2 * x[1] + 3 * u + 7, 0.1 * x[0] + 0.8 * x[1] - 5 * f - 11};
  };
  const AffineSample sample({2, 0}, next);
  std::vector<double> all{0.4, 42, -1.7}, expected{-1.7, 0.4};
  sample.step(all.data(), 0.3, -0.6);
  next(expected, 0.3, -0.6);
  EXPECT_NEAR(all[2], expected[0], 1e-14);
  EXPECT_NEAR(all[0], expected[1], 1e-14);
  EXPECT_EQ(all[1], 42);
}

AxisModel model_with(const std::string& viscous) {
  HiddenMachine machine;
  machine.viscous = viscous;
  HiddenAxis axis(machine);
  return AxisModel(axis.diagram(), axis.record("record", axis.nominal(), there_and_back(0.1, 0.2)), {});
}

// v' = (F - D v) / M of held forces, whose solution is exact.
TEST(AffineSample, OfALinearAxisFollowsItsLawWithEveryInertia) {
  AxisModel model = model_with("");
  ASSERT_TRUE(model.is_affine());
  const double damping = model.nominal_damping(), T = model.record().sample_time;
  for (const double added : {0.0, 0.1, 0.0}) {
    const double mass = 0.2621 + added, decay = std::exp(-damping / mass * T);
    ASSERT_TRUE(model.set_added_inertia(added));
    model.start(0.05, 0.3);
    double x = 0.05, v = 0.3;
    for (int k = 0; k < 200; ++k) {
      const double input = std::sin(0.1 * k), force = std::cos(0.07 * k);
      model.step(input, force);
      const double final_speed = (input + force) / damping;
      x += final_speed * T + (v - final_speed) * (1 - decay) * mass / damping;
      v = final_speed + (v - final_speed) * decay;
      ASSERT_NEAR(model.position(), x, 1e-9) << k;
      ASSERT_NEAR(model.velocity(), v, 1e-9) << k;
    }
  }
}

TEST(AffineSample, IsNotUsedWhereALawIsCurvedOrRemembers) {
  EXPECT_FALSE(model_with(R"("viscous": {"type": "PreslidingFriction", "level": {"value": 0.3, "unit": "N"},
                              "transition_distance": {"value": 1e-5, "unit": "m"},
                              "in": {"position": "mass.position", "velocity": "mass.velocity"}})")
                   .is_affine());
  EXPECT_FALSE(model_with(R"("viscous": {"type": "CoulombFriction", "mass": {"value": 0.2621, "unit": "kg"},
                              "level": {"value": 0.3, "unit": "N"},
                              "in": {"velocity": "mass.velocity", "applied": "motor.y"}})")
                   .is_affine());
  // Only beyond 90 % of the greatest speed.
  EXPECT_FALSE(model_with(R"("bound": {"type": "Saturation", "low": {"value": -0.18, "unit": "m/s"},
                              "high": {"value": 0.18, "unit": "m/s"}, "in": {"u": "mass.velocity"}},
  "viscous": {"type": "ViscousFriction", "damping": {"value": 3, "unit": "N*s/m"}, "in": {"velocity": "bound.y"}})")
                   .is_affine());
}

}  // namespace
}  // namespace loopwright::diagnosis::affine_sample_test
