#include <fmt/format.h>
#include <gtest/gtest.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::presliding_friction_test {

namespace {

void move(BlockUnderTest& friction, double position, double velocity = 0) {
  friction.input("position") = position;
  friction.input("velocity") = velocity;
  friction.evaluate();
  friction.accept();
}

/// A mass pushed by a sine of twice the friction.
std::string pushed(const std::string& solver) {
  return diagram(R"("push": {"type": "Sine", "amplitude": {"value": 2, "unit": "N"}, "frequency": 2},
    "sum": {"type": "Sum", "signs": "+-", "in": {"terms": ["push.y", "friction.force"]}},
    "friction": {"type": "PreslidingFriction", "level": 1, "transition_distance": 1e-4,
                 "in": {"position": "mass.position", "velocity": "mass.velocity"}},
    "mass": {"type": "Mass", "mass": 0.5, "in": {"force": "sum.sum"}})",
                 solver);
}

}  // namespace

TEST(PreslidingFriction, ReachesItsLevelWithinTheTransitionDistance) {
  BlockUnderTest friction("PreslidingFriction", R"({"level": 2, "transition_distance": 1e-3})");
  move(friction, 0.3);
  EXPECT_EQ(friction.output("force"), 0);  // starts unloaded at any position
  move(friction, 0.301);
  EXPECT_NEAR(friction.output("force"), 2 * (1 - std::exp(-1)), 1e-12);
  move(friction, 0.4);
  EXPECT_NEAR(friction.output("force"), 2, 1e-12);
  move(friction, 0.399);
  EXPECT_NEAR(friction.output("force"), 2 * (-1 + 2 * std::exp(-1)), 1e-12);
}

TEST(PreslidingFriction, DependsOnTheWayAndNotOnItsSteps) {
  BlockUnderTest coarse("PreslidingFriction", R"({"level": 1, "transition_distance": 0.2})"),
      fine("PreslidingFriction", R"({"level": 1, "transition_distance": 0.2})");
  const double turns[] = {0, 0.3, 0.1, 0.5, -0.2};
  move(coarse, 0), move(fine, 0);
  for (size_t i = 1; i < std::size(turns); ++i) {
    for (int k = 1; k <= 50; ++k) move(fine, turns[i - 1] + (turns[i] - turns[i - 1]) * k / 50);
    move(coarse, turns[i]);
    EXPECT_NEAR(coarse.output("force"), fine.output("force"), 1e-12) << i;
  }
}

/// Rounding would keep the last bits of where the motion began.
TEST(PreslidingFriction, ForgetsItsPastAfterManyTransitionDistances) {
  BlockUnderTest from_left("PreslidingFriction", R"({"level": 1, "transition_distance": 1e-3})"),
      from_right("PreslidingFriction", R"({"level": 1, "transition_distance": 1e-3})");
  move(from_left, -0.1), move(from_right, 0.1);
  for (int k = 0; k <= 300; ++k) move(from_left, 1e-4 * k), move(from_right, 1e-4 * k);
  EXPECT_EQ(from_left.output("fraction"), 1);
  EXPECT_EQ(from_right.output("fraction"), 1);
}

TEST(PreslidingFriction, FallsWithSpeedAlongStribecksCurve) {
  for (const double exponent : {1.0, 1.4, 2.0}) {
    BlockUnderTest friction("PreslidingFriction",
                            fmt::format(R"({{"level": 1, "static_level": 1.6, "stribeck_speed": 0.1,
                                             "exponent": {}, "transition_distance": 1e-6}})",
                                        exponent));
    move(friction, 0, 0.1), move(friction, 1, 0.1);
    EXPECT_NEAR(friction.output("force"), 1 + 0.6 * std::exp(-1), 1e-12);
    move(friction, 2, 0.15);
    EXPECT_NEAR(friction.output("force"), 1 + 0.6 * std::exp(-std::pow(1.5, exponent)), 1e-12) << exponent;
    move(friction, 3, 10);
    EXPECT_NEAR(friction.output("force"), 1, 1e-12);
  }
}

TEST(PreslidingFriction, HoldsWithoutCreepingUnderAForceBelowItsLevel) {
  const RunResult result = run_of(diagram(
      R"("push": {"type": "Constant", "value": {"value": 0.6, "unit": "N"}},
         "sum": {"type": "Sum", "signs": "+--", "in": {"terms": ["push.y", "friction.force", "viscous.force"]}},
         "viscous": {"type": "ViscousFriction", "damping": 20, "in": {"velocity": "mass.velocity"}},
         "friction": {"type": "PreslidingFriction", "level": 1, "transition_distance": 1e-4,
                      "in": {"position": "mass.position", "velocity": "mass.velocity"}},
         "mass": {"type": "Mass", "mass": 0.5, "in": {"force": "sum.sum"}})",
      R"("method": "rk4", "step": 0.001, "stop": 4)"));
  const auto& position = signal(result, "mass.position");
  EXPECT_NEAR(signal(result, "friction.force").back(), 0.6, 1e-9);
  EXPECT_GT(position.back(), 1e-5);
  EXPECT_NEAR(position.back(), position[position.size() / 2], 1e-12);
}

TEST(PreslidingFriction, FixedAndVariableStepsAgree) {
  const RunResult fixed =
      run_of(pushed(R"("method": "rk4", "step": 0.0001, "stop": 2, "record_step": 0.01)"));
  const RunResult variable =
      run_of(pushed(R"("method": "dopri5", "relative_tolerance": 1e-8, "absolute_tolerance": 1e-10, "stop": 2,
                       "record_step": 0.01)"));
  const auto &a = signal(fixed, "mass.position"), &b = signal(variable, "mass.position");
  ASSERT_EQ(a.size(), b.size());
  double largest = 0;
  for (double x : a) largest = std::max(largest, std::abs(x));
  for (size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-4 * largest) << i;
}

}  // namespace loopwright::presliding_friction_test
