#include <gmock/gmock.h>
#include "tests/engine/written_diagram.h"

namespace loopwright::several_axes_test {
namespace {

const char* const solver =
    R"("method": "dopri5", "stop": 4, "record_step": 0.01, "relative_tolerance": 1e-10, "absolute_tolerance": 1e-12)";

std::string limits(const std::string& more = "") {
  return R"("velocity": [0.5, 0.4], "acceleration": [2, 1], "jerk": [20, 30])" + more;
}

/// The integrals of the accelerations and velocities are the velocities and positions.
void expect_integrals(const RunResult& result, double tolerance) {
  for (const char* axis : {"[0]", "[1]"}) {
    const auto column = [&](const std::string& name) { return signal(result, name + axis); };
    const auto position = column("path.position"), velocity = column("path.velocity");
    for (size_t i = 0; i < position.size(); ++i) {
      ASSERT_NEAR(column("x.y")[i], position[i] - position[0], tolerance) << axis << i;
      ASSERT_NEAR(column("v.y")[i], velocity[i], tolerance) << axis << i;
    }
  }
}
const char* const integrals =
    R"(, "v": {"type": "Integrator", "in": {"u": "path.acceleration"}}, "x": {"type": "Integrator", "in": {"u": "path.velocity"}})";

TEST(SynchronizedMotion, AllAxesArriveAtTheSameInstantExactly) {
  const RunResult result = run_of(diagram(
      R"("a": {"type": "Step", "time": 0.5, "before": 0.6, "after": -0.2}, "b": {"type": "Step", "time": 0.5, "before": 0.1, "after": 0.15},
      "to": {"type": "Pack", "in": {"elements": ["a.y", "b.y"]}},
      "path": {"type": "SynchronizedMotion", )" +
          limits(R"(, "initial": [0.2, 0.3], "in": {"target": "to.y"}})") + integrals,
      solver));
  ASSERT_EQ(result.message, "");
  ASSERT_NO_FATAL_FAILURE(expect_integrals(result, 1e-9));
  EXPECT_EQ(signal(result, "path.position[0]").front(), 0.2);
  EXPECT_EQ(signal(result, "path.position[0]").back(), -0.2);
  EXPECT_EQ(signal(result, "path.position[1]").back(), 0.15);
  const auto &done = signal(result, "path.done"), &first = signal(result, "path.position[0]"),
             &second = signal(result, "path.position[1]");
  for (size_t i = 60; i < done.size(); ++i) {
    const bool first_is_there = first[i] == -0.2, second_is_there = second[i] == 0.15;
    EXPECT_TRUE((done[i] == 1) == (first_is_there && second_is_there)) << i;
    EXPECT_TRUE(first_is_there == second_is_there) << "neither is there before the other, row " << i;
  }
}

TEST(SynchronizedMotion, AResetPutsAllAxesAtRest) {
  const RunResult result = run_of(diagram(
      R"("to": {"type": "Constant", "value": [1, 2]}, "home": {"type": "Constant", "value": [5, 6]},
      "edge": {"type": "Step", "time": 0.5}, "path": {"type": "SynchronizedMotion", "sample_time": 0.01, )" +
          limits(R"(, "in": {"target": "to.y", "reset": "edge.y", "reset_value": "home.y"}})"),
      R"("stop": 1, "step": 0.01)"));
  ASSERT_EQ(result.message, "");
  EXPECT_EQ(signal(result, "path.position[0]")[50], 5);
  EXPECT_EQ(signal(result, "path.position[1]")[50], 6);
  EXPECT_LT(signal(result, "path.position[0]")[60], 5) << "it goes on to its target";
}

TEST(SynchronizedMotion, ReportsListsThatDoNotFit) {
  const std::string text = problems_of(diagram(
      R"("to": {"type": "Constant", "value": [1, 2]},
      "path": {"type": "SynchronizedMotion", "velocity": [1, 1], "acceleration": [1], "jerk": [1, 2, 3], "in": {"target": "to.y"}})"));
  EXPECT_THAT(text, testing::HasSubstr("acceleration"));
  EXPECT_THAT(text, testing::HasSubstr("jerk"));
  EXPECT_THAT(text, testing::HasSubstr("2, one for each of \"velocity\""));
}

const char* const points = R"(, "points": [[0, 0], [0.1, 0.2], [0.4, 0.25], [0.5, 0]])";

TEST(ViaPoints, PassesAllPointsAndEndsExactly) {
  const RunResult result =
      run_of(diagram(R"("go": {"type": "Step", "time": 0.3}, "path": {"type": "ViaPoints", )" +
                         limits(points) + R"(, "in": {"run": "go.y"}})" + integrals,
                     solver));
  ASSERT_EQ(result.message, "");
  ASSERT_NO_FATAL_FAILURE(expect_integrals(result, 1e-9));
  const auto &point = signal(result, "path.point"), &first = signal(result, "path.position[0]"),
             &second = signal(result, "path.position[1]"), &speed = signal(result, "path.velocity[0]");
  const std::vector<std::pair<double, double>> passed{{0, 0}, {0.1, 0.2}, {0.4, 0.25}, {0.5, 0}};
  for (size_t i = 1; i < point.size(); ++i) {
    const bool is_behind = first[i] >= 0.1 - 1e-12;
    EXPECT_TRUE((point[i] > 0) == is_behind) << i;
    if (point[i] == point[i - 1] || point[i] == 3) continue;
    // The point lies between the two rows.
    const auto [x, y] = passed[size_t(point[i])];
    EXPECT_LE(first[i - 1], x + 1e-12);
    EXPECT_GE(first[i], x - 1e-12);
    EXPECT_NEAR(second[i], y, 0.4 * 0.01);
    EXPECT_GT(speed[i], 0.01) << "it does not stop there";
  }
  EXPECT_EQ(first.back(), 0.5);
  EXPECT_EQ(second.back(), 0);
  EXPECT_EQ(signal(result, "path.done").back(), 1);
}

TEST(ViaPoints, SampledItIsTheSameMotion) {
  const auto with = [&](const std::string& more, const char* how) {
    return run_of(diagram(R"("path": {"type": "ViaPoints", )" + limits(points) + more + "}", how));
  };
  const RunResult sampled = with(R"(, "sample_time": 0.01)", R"("stop": 4, "step": 0.01)"),
                  smooth = with("", solver);
  const auto &a = signal(sampled, "path.position[1]"), &b = signal(smooth, "path.position[1]");
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], 1e-12) << i;
}

TEST(ViaPoints, ReportsPointsThatDoNotFit) {
  const std::string text = problems_of(diagram(
      R"("path": {"type": "ViaPoints", "points": [[0, 0], [1]], "velocity": [1, 1], "acceleration": [1, 1]})"));
  EXPECT_THAT(text, testing::HasSubstr("there is not one number for each axis"));
}

}  // namespace
}  // namespace loopwright::several_axes_test
