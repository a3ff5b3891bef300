#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include "tests/blocks/mechanics/driven_mass.h"

namespace loopwright::lu_gre_friction_test {

namespace {
constexpr auto settings =
    R"({"stiffness": 1e5, "bristle_damping": 300, "damping": 0.4, "level": 1, "static_level": 1.5,
                              "stribeck_speed": 0.001})";  // the paper's example values (σ₁ = √1e5 there)
double steady(double v) { return 1 + 0.5 * std::exp(-(v / 0.001) * (v / 0.001)); }
}  // namespace

TEST(LuGreFriction, SettlesOnTheStribeckCurveAtEverySpeed) {
  for (double velocity : {1e-4, 5e-4, 2e-3, -2e-3, 0.1, 5.0}) {
    BlockUnderTest friction("LuGreFriction", settings);
    friction.input("velocity") = velocity;
    const double duration = std::max(1.5, 5e-4 / std::abs(velocity));  // s; 33 times the largest deflection
    // Steps of 1e-4 s: at 5 m/s far beyond the stability limit of rk4, if the bristles were not limited.
    friction.advance(duration, int(duration / 1e-4));
    friction.evaluate(duration);
    EXPECT_NEAR(friction.output("force"), std::copysign(steady(velocity), velocity) + 0.4 * velocity, 1e-9)
        << velocity;
  }
}

TEST(LuGreFriction, ShortOfBreakawayItIsASpring) {
  BlockUnderTest friction("LuGreFriction", settings);
  friction.input("velocity") = 1e-6;
  friction.advance(0.5, 5000);  // 0.5 µm; without slip 0.05 N
  friction.evaluate(0.5);
  const double bristle = steady(1e-6) / 1e5;  // dz/dx = 1 - z / bristle
  const double z = bristle * (1 - std::exp(-0.5e-6 / bristle));
  EXPECT_NEAR(friction.output("deflection"), z, 1e-6 * z);
  EXPECT_NEAR(friction.output("force"), 1e5 * z, 1e-3);
}

TEST(LuGreFriction, BristlesNeverLeaveTheirBounds) {
  BlockUnderTest friction("LuGreFriction", settings);
  for (int i = 0; i < 20000; ++i) {
    friction.input("velocity") = 3 * std::sin(0.01 * i) * std::sin(0.7 * i);
    friction.step(1e-4);
    ASSERT_LE(std::abs(friction.state("deflection")), 1.5e-5 * (1 + 1e-9)) << "|z| ≤ Fs/σ₀";
  }
}

TEST(LuGreFriction, IsThePublishedModelAtLowSpeed) {
  BlockUnderTest friction("LuGreFriction", settings);
  friction.state("deflection") = 4e-6;
  friction.input("velocity") = 2e-3;
  friction.derivatives();
  const double rate = 2e-3 - 1e5 * 2e-3 / steady(2e-3) * 4e-6;
  EXPECT_NEAR(friction.rate("deflection"), rate, 1e-15);
  friction.evaluate();
  EXPECT_NEAR(friction.output("force"), 0.4 + 300 * rate + 0.4 * 2e-3, 1e-12);
}

TEST(LuGreFriction, HoldsASlowlyPushedMassWithinItsPresliding) {
  BlockUnderTest friction("LuGreFriction", settings);
  double x = 0, v = 0;
  for (int i = 0; i < 50000; ++i) {  // semi-implicit steps: velocity, then position
    friction.input("velocity") = v;
    friction.evaluate();
    v += 1e-4 * (0.7 * std::min(1.0, i / 4e4) - friction.output("force"));
    friction.input("velocity") = v;
    friction.step(1e-4);
    x += 1e-4 * v;
  }
  EXPECT_NEAR(x, -1.5e-5 * std::log(1 - 0.7 / 1.5), 1e-8) << "where the bristles carry 0.7 N";
  EXPECT_LT(std::abs(v), 1e-6);
}

}  // namespace loopwright::lu_gre_friction_test
