#include <gtest/gtest.h>
#include <cmath>
#include <numbers>
#include "tests/blocks/mechanics/driven_mass.h"

namespace loopwright::coulomb_friction_test {

namespace {
constexpr double m = 2.0, level = 3.0, breakaway = 4.0;  // kg, N, N
constexpr auto settings = R"({"level": 3, "static_level": 4, "mass": 2, "settling_time": 1e-3})";
}  // namespace

TEST(CoulombFriction, SlowSinePushSlipsAndSticksAtTheKnownInstants) {
  const double peak = 5.0, w = 2 * std::numbers::pi * 0.5, h = 1e-4;
  BlockUnderTest friction("CoulombFriction", settings);
  DrivenMass axis{friction, m, [&](double t, double, double) { return peak * std::sin(w * t); }};

  // Sliding forward from the breakaway: m v = ∫ (peak sin - level) dt. The mass comes to rest where this
  // returns to zero.
  const double slip = std::asin(breakaway / peak) / w;
  const auto speed = [&](double t) {
    return (peak / w * (std::cos(w * slip) - std::cos(w * t)) - level * (t - slip)) / m;
  };
  const double stop = root_between(slip + 0.2, 1.5, speed);
  const double travel =
      (peak / w * (std::cos(w * slip) * (stop - slip) - (std::sin(w * stop) - std::sin(w * slip)) / w) -
       level * (stop - slip) * (stop - slip) / 2) /
      m;
  ASSERT_LT(std::abs(peak * std::sin(w * stop)), breakaway) << "the case must really stick";

  std::vector<double> changes;  // times at which sliding begins or ends
  bool was_sliding = false;
  while (axis.time < 4.2) {
    const double now = axis.time, force = axis.step(h);
    const bool sliding = std::abs(force) == level && std::abs(axis.velocity) > 1e-5;
    if (sliding != was_sliding) changes.push_back(now);
    was_sliding = sliding;
  }
  ASSERT_EQ(changes.size(), 8u)
      << "a slip forward and one backward in each of two periods, and no chattering";
  EXPECT_NEAR(changes[0], slip, 2 * h);
  EXPECT_NEAR(changes[1], stop, 2 * h);
  EXPECT_NEAR(changes[2], slip + 1.0, 2 * h) << "half a period later, backward";
  EXPECT_NEAR(changes[3], stop + 1.0, 2 * h);

  friction.restart();
  DrivenMass once{friction, m, axis.applied};
  while (once.time < stop + 0.05) once.step(h);
  EXPECT_NEAR(once.position, travel, 1e-3 * travel);
  EXPECT_LT(std::abs(once.velocity), 1e-12) << "what was left of the velocity has settled";
}

TEST(CoulombFriction, RestingMassOnASlopeDoesNotCreep) {
  BlockUnderTest friction("CoulombFriction", settings);
  DrivenMass axis{friction, m, [](double, double, double) { return 3.9; }};
  for (int i = 0; i < 100000; ++i) axis.step(1e-3);
  EXPECT_EQ(axis.position, 0.0);
  EXPECT_EQ(axis.velocity, 0.0);
}

TEST(CoulombFriction, AStepAsLongAsTheSettlingTimeStillComesToRest) {
  BlockUnderTest friction("CoulombFriction", settings);
  DrivenMass axis{friction, m, [](double, double, double) { return 0.0; }};
  axis.velocity = 1.0;  // rests after m v / level = 0.667 s and m v²/2 / level = 0.333 m
  for (int i = 0; i < 660; ++i) EXPECT_EQ(axis.step(1e-3), level) << i;
  for (int i = 0; i < 60; ++i) axis.step(1e-3);
  EXPECT_NEAR(axis.position, 1.0 / 3.0, 2e-6);
  EXPECT_LT(std::abs(axis.velocity), 1e-12);
}

TEST(CoulombFriction, ReversesWithoutStickingWhenPushedHarderThanItHolds) {
  BlockUnderTest friction("CoulombFriction", settings);
  friction.input("velocity") = 0.1, friction.input("applied") = -10;
  friction.evaluate();
  EXPECT_EQ(friction.output("force"), level);
  friction.input("velocity") = -1e-9;
  friction.evaluate();
  EXPECT_EQ(friction.output("force"), -level);
}

TEST(CoulombFriction, MarginFallsThroughZeroWhereAPieceEnds) {
  BlockUnderTest friction("CoulombFriction", settings);
  const auto margin = [&](double velocity, double applied) {
    friction.input("velocity") = velocity, friction.input("applied") = applied;
    friction.crossings();
    return friction.crossing("sticking or breaking away");
  };
  friction.evaluate();  // stuck
  EXPECT_GT(margin(0, 3.999), 0);
  EXPECT_LT(margin(0, 4.001), 0);
  EXPECT_LT(margin(0, -4.001), 0);
  friction.input("velocity") = 0, friction.input("applied") = -4.001;
  friction.evaluate();  // sliding backward
  EXPECT_EQ(friction.output("force"), -level);
  EXPECT_GT(margin(-0.1, 0), 0);
  EXPECT_LT(margin(0.1, 0), 0);
  friction.input("velocity") = 0.1;
  friction.evaluate_held(0);
  EXPECT_EQ(friction.output("force"), -level) << "the piece is held inside a step";
}

TEST(CoulombFriction, WithoutTheOtherForcesItIsAClippedLineThroughZeroSpeed) {
  BlockUnderTest friction("CoulombFriction", R"({"level": 3, "mass": 2, "settling_time": 1e-3})");
  friction.input("velocity") = 1e-3;
  friction.evaluate();
  EXPECT_DOUBLE_EQ(friction.output("force"), 2.0);
  friction.input("velocity") = 1.6e-3;
  friction.evaluate();
  EXPECT_EQ(friction.output("force"), 3.0);
}

TEST(CoulombFriction, WithoutAStaticLevelItBreaksAwayAtItsLevel) {
  BlockUnderTest friction("CoulombFriction", R"({"level": 3, "mass": 2})");
  friction.input("applied") = 2.9;
  friction.evaluate();
  EXPECT_EQ(friction.output("force"), 2.9);
  friction.input("applied") = 3.1;
  friction.evaluate();
  EXPECT_EQ(friction.output("force"), 3.0);
}

TEST(CoulombFriction, NoFrictionIsNoForce) {
  BlockUnderTest friction("CoulombFriction", R"({"level": 0, "mass": 2})");
  for (double velocity : {-1.0, 0.0, 1e-9, 2.0})
    for (double applied : {-1.0, 0.0, 5.0}) {
      friction.input("velocity") = velocity, friction.input("applied") = applied;
      friction.evaluate();
      EXPECT_EQ(friction.output("force"), 0.0);
    }
}

TEST(CoulombFriction, AStaticLevelBelowTheLevelIsAnError) {
  BlockUnderTest friction("CoulombFriction", R"({"level": 3, "static_level": 2, "mass": 2})");
  ASSERT_TRUE(friction.problems().has_errors());
  EXPECT_NE(friction.problems().text().find("static_level >= level"), std::string::npos);
}

}  // namespace loopwright::coulomb_friction_test
