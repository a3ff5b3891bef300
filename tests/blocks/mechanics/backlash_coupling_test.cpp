#include <gtest/gtest.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::backlash_coupling_test {

namespace {
double force_at(BlockUnderTest& coupling, double deflection, double approach) {
  coupling.input("motor_position") = 5 + deflection, coupling.input("load_position") = 5;
  coupling.input("motor_velocity") = 1 + approach, coupling.input("load_velocity") = 1;
  coupling.evaluate();
  return coupling.output("force");
}
}  // namespace

TEST(BacklashCoupling, CarriesNothingInsideTheGapAndPushesBeyond) {
  BlockUnderTest coupling("BacklashCoupling", R"({"gap": 0.002, "stiffness": 1e5, "damping": 10})");
  EXPECT_EQ(force_at(coupling, 0.0009, 1), 0.0);
  EXPECT_EQ(force_at(coupling, -0.0009, -1), 0.0);
  EXPECT_NEAR(force_at(coupling, 0.0011, 0.5), 10 + 5, 1e-8);
  EXPECT_NEAR(force_at(coupling, -0.0011, -0.5), -10 - 5, 1e-8);
  EXPECT_EQ(force_at(coupling, 0.0011, -5), 0.0) << "it does not stick";
}

TEST(BacklashCoupling, CrossingsChangeSignWithContact) {
  BlockUnderTest coupling("BacklashCoupling", R"({"gap": 0.002, "stiffness": 1e5, "damping": 10})");
  for (double d : {-0.002, -0.0009, 0.0, 0.0009, 0.002})
    for (double v : {-20.0, 0.0, 20.0}) {
      const double force = force_at(coupling, d, v);
      coupling.crossings();
      EXPECT_EQ(coupling.crossing("forward contact") > 0, force > 0) << d << ' ' << v;
      EXPECT_EQ(coupling.crossing("backward contact") > 0, force < 0) << d << ' ' << v;
    }
}

TEST(BacklashCoupling, MotorTakesTheLoadAlongAfterTheGap) {
  // Equal masses, no damping: after the first impact the load continues with the motor's velocity and the
  // motor stands still.
  BlockUnderTest coupling("BacklashCoupling", R"({"gap": 0.01, "stiffness": 1e6})");
  double motor = 0, load = 0, motor_velocity = 1, load_velocity = 0;
  const double h = 1e-6;
  for (int i = 0; i < 9000;
       ++i) {  // contact after 5 ms, for π √(m/2k) = 2.2 ms; crossing the gap takes another 10 ms
    motor += h / 2 * motor_velocity, load += h / 2 * load_velocity;
    coupling.input("motor_position") = motor, coupling.input("load_position") = load;
    coupling.evaluate();
    motor_velocity -= h * coupling.output("force"), load_velocity += h * coupling.output("force");
    motor += h / 2 * motor_velocity, load += h / 2 * load_velocity;
  }
  EXPECT_NEAR(motor_velocity, 0.0, 2e-3);
  EXPECT_NEAR(load_velocity, 1.0, 2e-3);
}

}  // namespace loopwright::backlash_coupling_test
