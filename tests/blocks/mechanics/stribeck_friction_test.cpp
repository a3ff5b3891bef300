#include <gtest/gtest.h>
#include <cmath>
#include "tests/blocks/mechanics/driven_mass.h"

namespace loopwright::stribeck_friction_test {

TEST(StribeckFriction, SlidingForceFallsFromStaticToSlidingLevel) {
  for (double exponent : {0.5, 1.0, 2.0}) {
    BlockUnderTest friction(
        "StribeckFriction",
        R"({"level": 2, "static_level": 5, "stribeck_speed": 0.02, "exponent": 2, "mass": 1})");
    friction.tune("exponent", exponent);
    for (double speed : {0.011, 0.02, 0.05, 1.0}) {
      const double expected = 2 + 3 * std::exp(-std::pow(speed / 0.02, exponent));
      friction.input("velocity") = speed;
      friction.evaluate();
      EXPECT_NEAR(friction.output("force"), expected, 1e-13) << speed;
      friction.input("velocity") = -speed;
      friction.evaluate();
      EXPECT_NEAR(friction.output("force"), -expected, 1e-13) << speed;
    }
  }
}

TEST(StribeckFriction, BreaksAwayAtTheStaticLevelWithoutAJump) {
  BlockUnderTest friction("StribeckFriction",
                          R"({"level": 2, "static_level": 5, "stribeck_speed": 0.02, "mass": 1})");
  friction.input("applied") = 4.999;
  friction.evaluate();
  EXPECT_EQ(friction.output("force"), 4.999);
  friction.input("applied") = 5.001;
  friction.evaluate();
  EXPECT_EQ(friction.output("force"), 5.0);
}

TEST(StribeckFriction, PulledBySpringItSticksAndSlips) {
  // A mass pulled by a spring whose end moves slowly: the textbook case. While the mass sticks, the spring
  // extends. The mass first slips when the spring force reaches the static level, k v t = Fs.
  const double k = 100, drawing = 0.01, h = 1e-4;
  BlockUnderTest friction("StribeckFriction",
                          R"({"level": 2, "static_level": 5, "stribeck_speed": 0.02, "mass": 1})");
  DrivenMass axis{friction, 1.0, [&](double t, double x, double) { return k * (drawing * t - x); }};
  double first_slip = 0;
  int slips = 0;
  bool was_moving = false;
  while (axis.time < 30) {
    axis.step(h);
    const bool moving = std::abs(axis.velocity) > 1e-3;
    if (moving && !was_moving && ++slips == 1) first_slip = axis.time;
    was_moving = moving;
  }
  EXPECT_NEAR(first_slip, 5 / (k * drawing), 0.06);
  EXPECT_GE(slips, 4);
  EXPECT_LE(slips, 8)
      << "each slip lowers the spring force by up to 2 (Fs - Fc) = 6 N, drawn out anew at 1 N/s";
}

TEST(StribeckFriction, FrictionThatRisesWithSpeedIsAnError) {
  BlockUnderTest friction("StribeckFriction",
                          R"({"level": 6, "static_level": 5, "stribeck_speed": 0.02, "mass": 1})");
  ASSERT_TRUE(friction.problems().has_errors());
  EXPECT_NE(friction.problems().text().find("static_level >= level"), std::string::npos);
}

}  // namespace loopwright::stribeck_friction_test
