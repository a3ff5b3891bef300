#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::inertia_test {

TEST(Inertia, GainsSpeedByItsTorque) {
  BlockUnderTest rotor("Inertia", R"({"inertia": 0.002, "initial_angle": 3,
                                     "initial_velocity": 6.283185307179586})");
  ASSERT_FALSE(rotor.problems().has_errors()) << rotor.problems().text();
  rotor.input("torque") = 0.004;
  rotor.evaluate();
  rotor.derivatives();
  EXPECT_EQ(rotor.state("angle"), 3);
  EXPECT_NEAR(rotor.state("velocity"), 2 * pi, 1e-14);
  EXPECT_NEAR(rotor.output("acceleration"), 2, 1e-14);
  EXPECT_NEAR(rotor.rate("velocity"), 2, 1e-14);
  EXPECT_NEAR(rotor.rate("angle"), 2 * pi, 1e-14);
}

TEST(Inertia, RefusesNone) {
  EXPECT_TRUE(BlockUnderTest("Inertia", R"({"inertia": 0})").problems().has_errors());
}

}  // namespace loopwright::inertia_test
