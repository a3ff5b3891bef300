#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::force_saturation_test {

TEST(ForceSaturation, LosesForceWithTheSquareOfTheCommandUntilItStays) {
  BlockUnderTest motor("ForceSaturation", R"({"droop": 0.05})");
  for (auto [command, force] :
       {std::pair{0.0, 0.0}, {2.0, 1.8}, {-4.0, -3.2}, {10.0, 5.0}, {50.0, 5.0}, {-50.0, -5.0}}) {
    motor.input("command") = command;
    motor.evaluate();
    EXPECT_NEAR(motor.output("force"), force, 1e-12) << command;
  }
}

TEST(ForceSaturation, WithoutDroopItIsAWire) {
  BlockUnderTest motor("ForceSaturation", R"({"droop": 0})");
  motor.input("command") = 1e6;
  motor.evaluate();
  EXPECT_EQ(motor.output("force"), 1e6);
}

}  // namespace loopwright::force_saturation_test
