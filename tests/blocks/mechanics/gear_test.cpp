#include <gmock/gmock.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::gear_test {
namespace {

/// A gear of 50 : 1 whose output is pressed by this angle, moving at this velocity with both ends together.
void press(BlockUnderTest& gear, double deflection, double velocity, double ratio = 50) {
  gear.input("output_angle") = 0.7, gear.input("output_velocity") = velocity;
  gear.input("input_angle") = (0.7 + deflection) * ratio, gear.input("input_velocity") = velocity * ratio;
  gear.evaluate();
}

constexpr const char* lossy =
    R"({"ratio": 50, "stiffness": 2000, "efficiency": 0.8, "backwards_efficiency": 0.6, "transition": 0.001})";

TEST(Gear, DrivingAndDrivenPowersAreInTheRatioOfTheEfficiencies) {
  BlockUnderTest gear("Gear", lossy);
  for (const double velocity : {2.0, -2.0})
    for (const double deflection : {0.01, -0.01}) {
      press(gear, deflection, velocity);
      EXPECT_NEAR(gear.output("output_torque"), 2000 * deflection, 1e-9);
      const double out = gear.output("output_torque") * velocity,
                   in = gear.output("input_torque") * velocity * 50;
      if (out > 0)
        EXPECT_NEAR(out / in, 0.8, 1e-12);
      else
        EXPECT_NEAR(in / out, 0.6, 1e-12);
    }
  press(gear, 0.01, 0);
  EXPECT_NEAR(gear.output("input_torque") * 50, 20 * 0.5 * (1 / 0.8 + 0.6), 1e-9) << "the mean at rest";
}

TEST(Gear, WithoutLossesTheTorquesAreInTheRatio) {
  BlockUnderTest gear("Gear", R"({"ratio": -4, "stiffness": 100})");
  press(gear, 0.02, 1, -4);
  EXPECT_NEAR(gear.output("output_torque"), 2, 1e-12);
  EXPECT_NEAR(gear.output("input_torque"), -0.5, 1e-12) << "it turns back";
}

TEST(Gear, CarriesNothingWithinItsPlay) {
  BlockUnderTest gear("Gear", R"({"ratio": 50, "stiffness": 2000, "damping": 3, "gap": 0.004})");
  for (const double deflection : {-0.0019, 0.0, 0.0019}) {
    press(gear, deflection, 0);
    EXPECT_EQ(gear.output("output_torque"), 0) << deflection;
    EXPECT_EQ(gear.output("input_torque"), 0) << deflection;
  }
  press(gear, 0.003, 0);
  EXPECT_NEAR(gear.output("output_torque"), 2, 1e-9);
  gear.crossings();
  EXPECT_GT(gear.crossing("forward contact"), 0);
  EXPECT_LT(gear.crossing("backward contact"), 0);
}

TEST(Gear, RefusesWhatNoGearHas) {
  const auto text = [](const char* settings) { return BlockUnderTest("Gear", settings).problems().text(); };
  EXPECT_THAT(text(R"({"ratio": 0, "stiffness": 1})"), testing::HasSubstr("the ratio is zero"));
  EXPECT_THAT(text(R"({"ratio": 5, "stiffness": 1, "efficiency": 0, "transition": 1})"),
              testing::HasSubstr("above 0, at most 1"));
  EXPECT_THAT(text(R"({"ratio": 5, "stiffness": 1, "efficiency": 0.9})"), testing::HasSubstr("small beside"));
}

}  // namespace
}  // namespace loopwright::gear_test
