#include <gtest/gtest.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::end_stop_test {

namespace {
double force_at(BlockUnderTest& stop, double position, double velocity) {
  stop.input("position") = position, stop.input("velocity") = velocity;
  stop.evaluate();
  return stop.output("force");
}
}  // namespace

TEST(EndStop, PushesInsideEachStopAndNotBetween) {
  BlockUnderTest stop("EndStop", R"({"low": -1, "high": 2, "stiffness": 1000, "damping": 50})");
  EXPECT_EQ(force_at(stop, 0.5, 3), 0.0);
  EXPECT_NEAR(force_at(stop, 2.01, 0), 10.0, 1e-10);
  EXPECT_NEAR(force_at(stop, 2.01, 0.1), 15.0, 1e-10);
  EXPECT_NEAR(force_at(stop, -1.01, 0), -10.0, 1e-10);
  EXPECT_NEAR(force_at(stop, -1.01, -0.1), -15.0, 1e-10);
}

TEST(EndStop, NeverPulls) {
  BlockUnderTest stop("EndStop", R"({"low": -1, "high": 2, "stiffness": 1000, "damping": 50})");
  EXPECT_EQ(force_at(stop, 2.01, -1), 0.0);
  EXPECT_EQ(force_at(stop, -1.01, 1), 0.0);
  force_at(stop, 2.01, 0.1);
  stop.input("velocity") = -1;
  stop.evaluate_held(0);
  EXPECT_EQ(stop.output("force"), 0.0) << "nor inside a step";
}

TEST(EndStop, CrossingsChangeSignExactlyWithContact) {
  BlockUnderTest stop("EndStop", R"({"low": -1, "high": 2, "stiffness": 1000, "damping": 50})");
  for (double x : {-1.2, -1.01, -0.99, 0.0, 1.99, 2.01, 2.2})
    for (double v : {-1.0, -0.1, 0.0, 0.1, 1.0}) {
      const double force = force_at(stop, x, v);
      stop.crossings();
      EXPECT_EQ(stop.crossing("high stop") > 0, force > 0) << x << ' ' << v;
      EXPECT_EQ(stop.crossing("low stop") > 0, force < 0) << x << ' ' << v;
    }
}

TEST(EndStop, OneSidedStopHasNoOtherSide) {
  BlockUnderTest stop("EndStop", R"({"high": 2, "stiffness": 1000})");
  EXPECT_EQ(force_at(stop, -1e9, -5), 0.0);
  EXPECT_NEAR(force_at(stop, 2.001, 5), 1.0, 1e-9);
}

TEST(EndStop, BouncesBackWithoutLossWhenUndamped) {
  BlockUnderTest stop("EndStop", R"({"high": 0, "stiffness": 10000})");
  double x = -0.01, v = 1.0;  // 1 kg; contact lasts π/ω = 31.4 ms
  const double h = 1e-5;
  for (int i = 0; i < 6000; ++i) {
    x += h / 2 * v;  // leapfrog
    v -= h * force_at(stop, x, v);
    x += h / 2 * v;
  }
  EXPECT_NEAR(v, -1.0, 1e-3);
  EXPECT_LT(x, 0);
}

TEST(EndStop, StopsInTheWrongOrderAreAnError) {
  BlockUnderTest stop("EndStop", R"({"low": 2, "high": 1, "stiffness": 1})");
  ASSERT_TRUE(stop.problems().has_errors());
  EXPECT_NE(stop.problems().text().find("low < high"), std::string::npos);
}

}  // namespace loopwright::end_stop_test
