#include <gmock/gmock.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::dc_motor_test {
namespace {

TEST(DcMotor, FollowsTheEquationOfItsWinding) {
  BlockUnderTest motor(
      "DcMotor",
      R"({"resistance": 2.5, "inductance": 0.6e-3, "torque_constant": 0.038, "back_emf_constant": 0.04,
                                     "initial_current": 1.5})");
  motor.input("voltage") = 24, motor.input("velocity") = 100;
  motor.evaluate();
  motor.derivatives();
  EXPECT_NEAR(motor.rate("current"), (24 - 2.5 * 1.5 - 4) / 0.6e-3, 1e-9);
  EXPECT_NEAR(motor.output("torque"), 0.057, 1e-15);
  EXPECT_NEAR(motor.output("back_emf"), 4, 1e-14);
  EXPECT_NEAR(motor.output("heat"), 2.5 * 2.25, 1e-14);
}

TEST(DcMotor, OneConstantGivesTheOther) {
  for (const char* constant : {R"("torque_constant": 0.038)", R"("back_emf_constant": 0.038)"}) {
    BlockUnderTest motor(
        "DcMotor",
        std::string(R"({"resistance": 1, "inductance": 1, "initial_current": 2, )") + constant + "}");
    ASSERT_FALSE(motor.problems().has_errors()) << motor.problems().text();
    motor.input("velocity") = 10;
    motor.evaluate();
    EXPECT_NEAR(motor.output("torque"), 0.076, 1e-12) << constant;
    EXPECT_NEAR(motor.output("back_emf"), 0.38, 1e-12) << constant;
  }
}

TEST(DcMotor, NeedsAConstant) {
  EXPECT_THAT(BlockUnderTest("DcMotor", R"({"resistance": 1, "inductance": 1})").problems().text(),
              testing::HasSubstr("the motor has no constant"));
}

}  // namespace
}  // namespace loopwright::dc_motor_test
