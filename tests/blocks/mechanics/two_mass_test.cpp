#include <gtest/gtest.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::two_mass_test {

TEST(TwoMass, SwingsAtItsNaturalFrequencyAboutTheCommonMotion) {
  BlockUnderTest axis("TwoMass", R"({"motor_mass": 1, "load_mass": 0.25, "stiffness": 100})");
  axis.input("force") = 2;
  axis.advance(1.3, 13000);
  const double t = 1.3, w = std::sqrt(100 * (1 + 1 / 0.25));
  const double centre = 0.5 * 2 / 1.25 * t * t;                // F / (m₁ + m₂)
  const double between = 2 / (w * w) * (1 - std::cos(w * t));  // x₁ - x₂ of a step force on the motor
  EXPECT_NEAR(axis.state("motor_position"), centre + 0.2 * between, 1e-9);
  EXPECT_NEAR(axis.state("load_position"), centre - 0.8 * between, 1e-9);
  axis.evaluate(t);
  EXPECT_NEAR(axis.output("coupling_force"), 100 * between, 1e-7);
}

TEST(TwoMass, CouplingForceDampsTheRelativeVelocity) {
  BlockUnderTest axis("TwoMass", R"({"motor_mass": 2, "load_mass": 4, "stiffness": 100, "damping": 7})");
  axis.state("motor_position") = 0.1, axis.state("load_velocity") = -1;
  axis.input("force") = 30, axis.input("load_force") = 3;
  axis.derivatives();
  EXPECT_DOUBLE_EQ(axis.rate("motor_velocity"), (30 - 17) / 2.0);
  EXPECT_DOUBLE_EQ(axis.rate("load_velocity"), (17 - 3) / 4.0);
}

TEST(TwoMass, StartsWhereItIsTold) {
  BlockUnderTest axis("TwoMass", R"({"motor_mass": 1, "load_mass": 1, "stiffness": 1, "initial_position": 3,
                                     "initial_velocity": -2})");
  for (auto [port, value] : {std::pair{"motor_position", 3.0},
                             {"load_position", 3.0},
                             {"motor_velocity", -2.0},
                             {"load_velocity", -2.0}})
    EXPECT_EQ(axis.state(port), value) << port;
}

}  // namespace loopwright::two_mass_test
