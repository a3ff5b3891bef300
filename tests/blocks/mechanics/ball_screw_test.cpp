#include <gmock/gmock.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::ball_screw_test {
namespace {

TEST(BallScrew, OneTurnMovesTheNutByTheLead) {
  BlockUnderTest screw(
      "BallScrew", R"({"lead": 0.01, "stiffness": 8e7})");
  screw.input("angle") = 4 * pi, screw.input("position") = 0.02;
  screw.evaluate();
  EXPECT_NEAR(screw.output("force"), 0, 1e-6);
  screw.input("position") = 0.02 - 5e-6;
  screw.evaluate();
  EXPECT_NEAR(screw.output("force"), 400, 1e-6);
  EXPECT_NEAR(screw.output("torque"), 400 * 0.01 / (2 * pi), 1e-9);
}

TEST(BallScrew, PowersAreInTheRatioOfTheEfficiencies) {
  BlockUnderTest screw("BallScrew",
                       R"({"lead": 0.01, "stiffness": 8e7, "efficiency": 0.9, "transition": 1e-4})");
  screw.input("angle") = 0, screw.input("position") = -5e-6;
  for (const double velocity : {0.1, -0.1}) {
    screw.input("velocity") = velocity, screw.input("angular_velocity") = velocity * 2 * pi / 0.01;
    screw.evaluate();
    const double out = screw.output("force") * velocity,
                 in = screw.output("torque") * screw.input("angular_velocity");
    EXPECT_NEAR(velocity > 0 ? out / in : in / out, 0.9, 1e-12);
  }
}

TEST(BallScrew, HasPlay) {
  BlockUnderTest screw("BallScrew", R"({"lead": 0.01, "stiffness": 8e7, "gap": 8e-6})");
  screw.input("position") = 3.9e-6;
  screw.evaluate();
  EXPECT_EQ(screw.output("force"), 0);
  screw.input("position") = 5e-6;
  screw.evaluate();
  EXPECT_NEAR(screw.output("force"), -80, 1e-6);
}

TEST(BallScrew, RefusesALeadOfZero) {
  EXPECT_THAT(BlockUnderTest("BallScrew", R"({"lead": 0, "stiffness": 1})").problems().text(),
              testing::HasSubstr("the lead is zero"));
}

}  // namespace
}  // namespace loopwright::ball_screw_test
