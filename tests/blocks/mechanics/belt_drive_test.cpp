#include <gmock/gmock.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::belt_drive_test {
namespace {

TEST(BeltDrive, IsASpringAndADamperBehindAPulley) {
  BlockUnderTest belt("BeltDrive", R"({"radius": 0.015, "stiffness": 2e5, "damping": 60})");
  belt.input("angle") = 2, belt.input("position") = 0.0299;
  belt.input("angular_velocity") = 10, belt.input("velocity") = 0.14;
  belt.evaluate();
  EXPECT_NEAR(belt.output("force"), 2e5 * 1e-4 + 60 * 0.01, 1e-9);
  EXPECT_NEAR(belt.output("torque"), 0.015 * belt.output("force"), 1e-12);
}

TEST(BeltDrive, PullsBothWays) {
  BlockUnderTest belt("BeltDrive", R"({"radius": 0.015, "stiffness": 2e5, "damping": 60})");
  belt.input("position") = 1e-4, belt.input("velocity") = -1;
  belt.evaluate();
  EXPECT_NEAR(belt.output("force"), -20 + 60, 1e-9);
}

TEST(BeltDrive, PowersAreInTheRatioOfTheEfficiencies) {
  BlockUnderTest belt(
      "BeltDrive",
      R"({"radius": 0.02, "stiffness": 1e5, "efficiency": 0.95, "backwards_efficiency": 0.93, "transition": 1e-3})");
  belt.input("position") = -1e-4;
  for (const double velocity : {0.5, -0.5}) {
    belt.input("velocity") = velocity, belt.input("angular_velocity") = velocity / 0.02;
    belt.evaluate();
    const double out = belt.output("force") * velocity, in = belt.output("torque") * velocity / 0.02;
    EXPECT_NEAR(velocity > 0 ? out / in : in / out, velocity > 0 ? 0.95 : 0.93, 1e-12);
  }
}

TEST(BeltDrive, RefusesLossesWithoutAWidth) {
  EXPECT_THAT(
      BlockUnderTest("BeltDrive", R"({"radius": 1, "stiffness": 1, "efficiency": 0.9})").problems().text(),
      testing::HasSubstr("small beside"));
}

}  // namespace
}  // namespace loopwright::belt_drive_test
