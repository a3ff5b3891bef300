#include <gmock/gmock.h>
#include <cmath>
#include "models/motion/cubic_spline.h"
#include "tests/blocks/block_under_test.h"

namespace loopwright::cam_table_test {
namespace {

TEST(CubicSpline, ReproducesWhatItsEndsAllow) {
  // A cubic with slope 0 at both ends is its own spline.
  std::vector<double> x{0, 0.1, 0.25, 0.7, 1}, y;
  for (double at : x) y.push_back(3 * at * at - 2 * at * at * at);
  const CubicSpline at_rest(x, y, SplineEnds::at_rest);
  for (double at = 0; at <= 1; at += 0.01) {
    EXPECT_NEAR(at_rest.at(at).value, 3 * at * at - 2 * at * at * at, 1e-14);
    EXPECT_NEAR(at_rest.at(at).slope, 6 * at - 6 * at * at, 1e-13);
    EXPECT_NEAR(at_rest.at(at).bend, 6 - 12 * at, 1e-12);
  }
  const CubicSpline line({0, 1, 3}, {1, 2, 4}, SplineEnds::natural);
  EXPECT_NEAR(line.at(2.5).value, 3.5, 1e-15);
}

TEST(CubicSpline, APeriodicOneIsSmoothEverywhere) {
  for (const size_t points : {3u, 4u, 6u, 13u}) {
    std::vector<double> x, y;
    for (size_t i = 0; i < points; ++i) {
      x.push_back(double(i) + 0.2 * std::sin(double(i)));
      y.push_back(std::cos(2.0 * double(i)));
    }
    y.back() = y.front();
    const CubicSpline spline(x, y, SplineEnds::periodic);
    const auto near = [](const SplinePoint& a, const SplinePoint& b) {
      EXPECT_NEAR(a.value, b.value, 1e-7);
      EXPECT_NEAR(a.slope, b.slope, 1e-6);
      EXPECT_NEAR(a.bend, b.bend, 1e-6);
    };
    for (size_t i = 1; i + 1 < points; ++i) near(spline.at(x[i] - 1e-9), spline.at(x[i] + 1e-9));
    near(spline.at(x.front()), spline.at(x.back()));
    for (size_t i = 0; i < points; ++i) EXPECT_NEAR(spline.at(x[i]).value, y[i], 1e-13);
  }
}

TEST(CamTable, VelocityAndAccelerationAreThoseOfTheMotion) {
  BlockUnderTest cam(
      "CamTable",
      R"({"master": [0, 1, 2.5, 4], "slave": [0, 0.3, -0.2, 0], "ends": "periodic", "cyclic": true})");
  ASSERT_FALSE(cam.problems().has_errors()) << cam.problems().text();
  const auto position = [&](double t) {
    cam.input("position") = 3 * t + 0.4 * std::sin(t), cam.input("velocity") = 3 + 0.4 * std::cos(t);
    cam.input("acceleration") = -0.4 * std::sin(t);
    cam.evaluate();
    return cam.output("slave_position");
  };
  const double h = 1e-4;
  for (double t = -5; t < 5; t += 0.0137) {
    const double before = position(t - h), after = position(t + h), now = position(t);
    EXPECT_NEAR(cam.output("slave_velocity"), (after - before) / (2 * h), 1e-5) << t;
    EXPECT_NEAR(cam.output("slave_acceleration"), (after - 2 * now + before) / (h * h), 2e-3) << t;
  }
}

TEST(CamTable, AFeederGoesOnAndOthersHoldTheirEnds) {
  BlockUnderTest feeder("CamTable", R"({"master": [0, 1, 2], "slave": [0, 1, 5], "cyclic": true})"),
      once("CamTable", R"({"master": [0, 1, 2], "slave": [0, 1, 5]})");
  for (BlockUnderTest* block : {&feeder, &once})
    block->input("position") = 7, block->input("velocity") = 2, block->evaluate();
  EXPECT_NEAR(feeder.output("slave_position"), 3 * 5 + 1, 1e-12);
  EXPECT_EQ(once.output("slave_position"), 5);
  EXPECT_EQ(once.output("slave_velocity"), 0);
  feeder.input("position") = -1;
  feeder.evaluate();
  EXPECT_NEAR(feeder.output("slave_position"), -5 + 1, 1e-12);
}

TEST(CamTable, RefusesWhatIsNoTable) {
  const auto text = [](const char* settings) {
    return BlockUnderTest("CamTable", settings).problems().text();
  };
  EXPECT_THAT(text(R"({"master": [0], "slave": [0]})"), testing::HasSubstr("two points"));
  EXPECT_THAT(text(R"({"master": [0, 2, 1], "slave": [0, 1]})"),
              testing::AllOf(testing::HasSubstr("do not rise"), testing::HasSubstr("3 numbers")));
  EXPECT_THAT(text(R"({"master": [0, 1], "slave": [0, 1], "ends": "periodic"})"),
              testing::HasSubstr("cyclic"));
}

}  // namespace
}  // namespace loopwright::cam_table_test
