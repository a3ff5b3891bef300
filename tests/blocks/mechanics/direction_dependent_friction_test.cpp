#include <gtest/gtest.h>
#include <cmath>
#include "tests/blocks/mechanics/driven_mass.h"

namespace loopwright::direction_dependent_friction_test {

namespace {
constexpr auto settings =
    R"({"level_forward": 2, "level_backward": 3, "damping_forward": 10, "damping_backward": 20,
                              "mass": 1})";
}

TEST(DirectionDependentFriction, EachDirectionHasItsOwnLevelAndDamping) {
  BlockUnderTest friction("DirectionDependentFriction", settings);
  friction.input("velocity") = 0.5;
  friction.evaluate();
  EXPECT_DOUBLE_EQ(friction.output("force"), 2 + 5);
  friction.input("velocity") = -0.5;
  friction.evaluate();
  EXPECT_DOUBLE_EQ(friction.output("force"), -3 - 10);
}

TEST(DirectionDependentFriction, HoldsHarderAgainstBackwardPush) {
  BlockUnderTest friction("DirectionDependentFriction", settings);
  for (auto [applied, force] : {std::pair{1.9, 1.9}, {-2.9, -2.9}, {2.1, 2.0}}) {
    friction.restart();
    friction.input("applied") = applied;
    friction.evaluate();
    EXPECT_EQ(friction.output("force"), force);
  }
  friction.restart();
  friction.input("applied") = -3.1;
  friction.evaluate();
  EXPECT_EQ(friction.output("force"), -3.0);
}

TEST(DirectionDependentFriction, ThrownMassStopsWhereItShouldAndStays) {
  BlockUnderTest friction("DirectionDependentFriction", R"({"level_forward": 2, "level_backward": 3,
      "damping_forward": 0, "damping_backward": 0, "mass": 1})");
  DrivenMass axis{friction, 1.0, [](double, double, double) { return -2.5; }};
  axis.velocity = 1.0;  // stops after 1/(2 · 4.5) m; 2.5 N cannot push it back, 3 N could
  while (axis.time < 1) axis.step(1e-4);
  EXPECT_NEAR(axis.position, 1 / 9.0, 1e-6);
  EXPECT_LT(std::abs(axis.velocity), 1e-12);
}

TEST(DirectionDependentFriction, WithoutLevelsItIsViscousOnly) {
  BlockUnderTest friction("DirectionDependentFriction", R"({"damping_forward": 10, "damping_backward": 20})");
  ASSERT_FALSE(friction.problems().has_errors()) << friction.problems().text();
  for (auto [velocity, force] : {std::pair{0.0, 0.0}, {0.1, 1.0}, {-0.1, -2.0}, {1e-9, 1e-8}}) {
    friction.input("velocity") = velocity, friction.input("applied") = 7;
    friction.evaluate();
    EXPECT_DOUBLE_EQ(friction.output("force"), force);
  }
  friction.input("velocity") = -0.1;
  friction.evaluate_held(0);
  EXPECT_DOUBLE_EQ(friction.output("force"), -2.0) << "right whatever piece is held";
}

TEST(DirectionDependentFriction, DryFrictionWithoutMassIsAnError) {
  BlockUnderTest friction("DirectionDependentFriction",
                          R"({"level_forward": 1, "damping_forward": 10, "damping_backward": 20})");
  ASSERT_TRUE(friction.problems().has_errors());
  EXPECT_NE(friction.problems().text().find("\"mass\""), std::string::npos);
}

}  // namespace loopwright::direction_dependent_friction_test
