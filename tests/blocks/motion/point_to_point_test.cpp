#include <gmock/gmock.h>
#include "tests/blocks/block_under_test.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::point_to_point_test {
namespace {

const char* const limits = R"({"velocity": 0.5, "acceleration": 2, "jerk": 20, "initial": 0.1})";

TEST(PointToPoint, StandsAtItsInitialPositionAndEndsExactlyAtTheTarget) {
  BlockUnderTest block("PointToPoint", limits);
  block.input("target") = 0.1;
  block.evaluate(0);
  EXPECT_EQ(block.output("position"), 0.1);
  EXPECT_EQ(block.output("done"), 1);
  block.input("target") = 0.7;
  block.evaluate(1);
  EXPECT_EQ(block.output("position"), 0.1);
  EXPECT_EQ(block.output("done"), 0);
  const double duration = 0.6 / 0.5 + 0.5 / 2 + 2.0 / 20;
  block.evaluate(1 + duration - 1e-9);
  EXPECT_EQ(block.output("done"), 0);
  block.evaluate(1 + duration + 1e-9);
  EXPECT_EQ(block.output("position"), 0.7);
  EXPECT_EQ(block.output("velocity"), 0);
  EXPECT_EQ(block.output("acceleration"), 0);
  EXPECT_EQ(block.output("done"), 1);
}

TEST(PointToPoint, FollowsANewTargetWithoutAJump) {
  BlockUnderTest block("PointToPoint", limits, 1e-3);
  double last_position = 0.1, last_velocity = 0, last_acceleration = 0;
  for (int k = 0; k < 4000; ++k) {
    block.input("target") = k < 400 ? 1 : k < 900 ? -0.3 : k < 950 ? 0.2 : 0.15;
    block.evaluate(k * 1e-3, k);
    const double position = block.output("position"), velocity = block.output("velocity"),
                 acceleration = block.output("acceleration");
    ASSERT_NEAR(position, last_position + 1e-3 * (velocity + last_velocity) / 2, 20 * 1e-9) << k;
    ASSERT_NEAR(velocity, last_velocity + 1e-3 * (acceleration + last_acceleration) / 2, 20 * 1e-6) << k;
    ASSERT_LE(std::fabs(acceleration - last_acceleration), 20e-3 * (1 + 1e-9)) << k;
    ASSERT_LE(std::fabs(velocity), 0.5 * (1 + 1e-12));
    last_position = position, last_velocity = velocity, last_acceleration = acceleration;
  }
  EXPECT_EQ(last_position, 0.15);
  EXPECT_EQ(block.output("done"), 1);
}

TEST(PointToPoint, AResetPutsItAtRest) {
  BlockUnderTest block("PointToPoint", limits);
  block.input("target") = 1;
  block.evaluate(0);
  block.evaluate(0.5);
  EXPECT_GT(block.output("velocity"), 0);
  block.input("reset") = 1, block.input("reset_value") = -4, block.input("target") = -4;
  block.evaluate(0.6);
  EXPECT_EQ(block.output("position"), -4);
  EXPECT_EQ(block.output("velocity"), 0);
  EXPECT_EQ(block.output("done"), 1);
  block.input("target") = -3;
  block.evaluate(0.7);
  block.evaluate(0.8);
  EXPECT_GT(block.output("position"), -4) << "a reset that stays true is no second edge";
}

TEST(PointToPoint, ItsOutputsAreEachOthersIntegrals) {
  // A variable-step solver stops at the borders of the phases, and is as exact as its tolerance.
  const RunResult result = run_of(diagram(
      R"("target": {"type": "Step", "time": 0.2, "after": {"value": 0.3, "unit": "m"}},
      "path": {"type": "PointToPoint", "velocity": 0.5, "acceleration": 2, "jerk": 20, "in": {"target": "target.y"}},
      "velocity": {"type": "Integrator", "in": {"u": "path.acceleration"}},
      "position": {"type": "Integrator", "in": {"u": "path.velocity"}})",
      R"("method": "dopri5", "stop": 2, "record_step": 0.001, "relative_tolerance": 1e-10, "absolute_tolerance": 1e-12)"));
  const auto &position = signal(result, "position.y"), &velocity = signal(result, "velocity.y");
  for (size_t i = 0; i < position.size(); ++i) {
    ASSERT_NEAR(position[i], signal(result, "path.position")[i], 1e-10) << i;
    ASSERT_NEAR(velocity[i], signal(result, "path.velocity")[i], 1e-10) << i;
  }
  EXPECT_NEAR(position.back(), 0.3, 1e-10);
}

TEST(PointToPoint, StopsAtATargetThatIsNoNumber) {
  for (const double target : {std::nan(""), infinity}) {
    BlockUnderTest block("PointToPoint", limits);
    block.input("target") = target;
    block.evaluate();
    EXPECT_EQ(block.fault(), "there is no finite motion to this target");
  }
}

TEST(PointToPoint, AContinuousTargetNeedsASampleTime) {
  const char* const moving =
      R"("t": {{"type": "Clock"}}, "x": {{"type": "Integrator", "in": {{"u": "path.velocity"}}}},
      "path": {{"type": "PointToPoint", "velocity": 5, "acceleration": 20, "jerk": 200{}, "in": {{"target": "t.time"}}}})";
  const char* const solver = R"("method": "dopri5", "stop": 1, "record_step": 0.1)";
  const RunResult result = run_of(diagram(fmt::format(fmt::runtime(moving), ""), solver));
  EXPECT_THAT(result.message, testing::HasSubstr("sample_time"));
  EXPECT_EQ(run_of(diagram(fmt::format(fmt::runtime(moving), R"(, "sample_time": 0.01)"), solver)).message,
            "");
}

}  // namespace
}  // namespace loopwright::point_to_point_test
