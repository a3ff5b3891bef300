#include <gtest/gtest.h>
#include <cmath>
#include <numbers>
#include "tests/blocks/block_under_test.h"

namespace loopwright::cogging_force_test {

namespace {
constexpr double pitch = 0.0225, turn = 2 * std::numbers::pi;  // m, rad
double force_at(BlockUnderTest& cogging, double position, double velocity = 0) {
  cogging.input("position") = position, cogging.input("velocity") = velocity;
  cogging.evaluate();
  return cogging.output("force");
}
}  // namespace

TEST(CoggingForce, SumsItsHarmonics) {
  BlockUnderTest cogging("CoggingForce", R"({"pole_pitch": 0.0225, "harmonics": [
      {"amplitude": 2, "phase": 0.4}, {"order": 3, "amplitude": 0.5}]})");
  for (double x : {-0.3, 0.0, 0.01, 0.6}) {
    const double expected = 2 * std::sin(turn * x / pitch + 0.4) + 0.5 * std::sin(3 * turn * x / pitch);
    EXPECT_NEAR(force_at(cogging, x), expected, 1e-12);
    EXPECT_NEAR(force_at(cogging, x + pitch), expected, 1e-12);
  }
}

TEST(CoggingForce, AmplitudeFallsWithSpeedInBothDirectionsDownToZero) {
  BlockUnderTest cogging("CoggingForce",
                         R"({"pole_pitch": 0.0225, "harmonics": [{"amplitude": 2}], "velocity_slope": 0.6})");
  const double x = pitch / 4;
  EXPECT_NEAR(force_at(cogging, x, 0.5), 2 * 0.7, 1e-12);
  EXPECT_NEAR(force_at(cogging, x, -0.5), 2 * 0.7, 1e-12);
  EXPECT_EQ(force_at(cogging, x, 10), 0.0);
}

TEST(CoggingForce, ModulationVariesTheAmplitudeAlongTheTrack) {
  BlockUnderTest cogging("CoggingForce", R"({"pole_pitch": 0.0225, "harmonics": [{"amplitude": 2}],
      "modulation": {"depth": 0.08, "period": 0.36, "phase": 0.3}})");
  const double x = pitch / 4 + 5 * pitch;
  EXPECT_NEAR(force_at(cogging, x), 2 * (1 + 0.08 * std::sin(turn * x / 0.36 + 0.3)), 1e-12);
}

TEST(CoggingForce, AmplitudesCanBeSwept) {
  BlockUnderTest cogging("CoggingForce", R"({"pole_pitch": 0.0225, "harmonics": [{"amplitude": 2}]})");
  cogging.tune("harmonics.0.amplitude", 5);
  EXPECT_NEAR(force_at(cogging, pitch / 4), 5, 1e-12);
}

TEST(CoggingForce, PolePitchMustBePositive) {
  BlockUnderTest cogging("CoggingForce", R"({"pole_pitch": 0, "harmonics": []})");
  EXPECT_TRUE(cogging.problems().has_errors());
}

}  // namespace loopwright::cogging_force_test
