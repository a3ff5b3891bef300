#include <gtest/gtest.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::current_controller_test {
namespace {

constexpr double R = 0.8, L_d = 0.003, L_q = 0.005, flux = 0.06, bandwidth = 1000, sample_time = 1e-5;
constexpr int pole_pairs = 4;

/// The windings, by the equations of Krause and Euler steps a hundred times shorter than a sample.
struct Windings {
  double d = 0, q = 0;
  void sample(double u_d, double u_q, double velocity) {
    constexpr int parts = 100;
    const double h = sample_time / parts, field = pole_pairs * velocity;
    for (int i = 0; i < parts; ++i) {
      const double rate_d = (u_d - R * d + field * L_q * q) / L_d;
      const double rate_q = (u_q - R * q - field * (L_d * d + flux)) / L_q;
      d += h * rate_d, q += h * rate_q;
    }
  }
};

struct Loop {
  explicit Loop(const std::string& more = "")
      : controller("CurrentController",
                   R"({"resistance": 0.8, "inductance_d": 0.003, "inductance_q": 0.005, "flux": 0.06,
                       "pole_pairs": 4, "bandwidth": 1000)" +
                       more + "}",
                   sample_time) {}
  void run(double duration, double velocity) {
    controller.input("velocity") = velocity;
    for (int k = 0; k < std::lround(duration / sample_time); ++k) {
      controller.input("current_d") = windings.d, controller.input("current_q") = windings.q;
      controller.evaluate();
      u_d = controller.output("voltage_d"), u_q = controller.output("voltage_q");
      controller.update();
      windings.sample(u_d, u_q, velocity);
    }
  }
  BlockUnderTest controller;
  Windings windings;
  double u_d = 0, u_q = 0;
};

TEST(CurrentController, EachCurrentFollowsWithItsBandwidthAndLeavesTheOtherAlone) {
  Loop loop;
  loop.run(0.02, 150);  // turning: the voltage of the magnets is compensated from the first sample on
  EXPECT_NEAR(loop.windings.q, 0, 0.02);
  loop.controller.input("reference_q") = 5;
  for (int i = 1; i <= 5; ++i) {
    loop.run(0.0005, 150);
    EXPECT_NEAR(loop.windings.q, 5 * (1 - std::exp(-bandwidth * 0.0005 * i)), 0.05) << i;
    EXPECT_NEAR(loop.windings.d, 0, 0.05) << i;
  }
}

TEST(CurrentController, HasNoErrorAtRestAndAtSpeed) {
  Loop loop;
  loop.controller.input("reference_d") = -3, loop.controller.input("reference_q") = 4;
  for (const double velocity : {0.0, 200.0, -120.0}) {
    loop.run(0.15, velocity);  // 24 time constants of the windings
    EXPECT_NEAR(loop.windings.d, -3, 1e-6) << velocity;
    EXPECT_NEAR(loop.windings.q, 4, 1e-6) << velocity;
    const double field = pole_pairs * velocity;
    EXPECT_NEAR(loop.u_d, R * -3 - field * L_q * 4, 1e-4);
    EXPECT_NEAR(loop.u_q, R * 4 + field * (L_d * -3 + flux), 1e-4);
  }
}

TEST(CurrentController, ALimitKeepsTheDirectionOfTheVoltage) {
  const std::string settings = R"({"resistance": 0.8, "inductance_d": 0.003, "inductance_q": 0.005,
                                   "bandwidth": 1000)";
  BlockUnderTest free("CurrentController", settings + "}", sample_time);
  BlockUnderTest limited("CurrentController", settings + R"(, "voltage_limit": 2})", sample_time);
  for (BlockUnderTest* block : {&free, &limited}) {
    block->input("reference_d") = -2, block->input("reference_q") = 3;
    block->evaluate();
  }
  EXPECT_NEAR(free.output("voltage_d"), bandwidth * L_d * -2, 1e-12);
  EXPECT_NEAR(free.output("voltage_q"), bandwidth * L_q * 3, 1e-12);
  EXPECT_NEAR(std::hypot(limited.output("voltage_d"), limited.output("voltage_q")), 2, 1e-12);
  EXPECT_NEAR(limited.output("voltage_d") / limited.output("voltage_q"),
              free.output("voltage_d") / free.output("voltage_q"), 1e-12);
}

TEST(CurrentController, DoesNotWindUpWhileTheVoltageIsLimited) {
  // 10 A need 8 V: with 7 V the reference is never reached; 30 ms later a smaller one is, without overshoot.
  Loop loop(R"(, "voltage_limit": 7)");
  loop.controller.input("reference_q") = 10;
  loop.run(0.03, 0);
  EXPECT_NEAR(loop.windings.q, 7 / R, 0.1);
  loop.controller.input("reference_q") = 5;
  double lowest = 10;
  for (int i = 0; i < 100; ++i) {
    loop.run(0.0001, 0);
    lowest = std::min(lowest, loop.windings.q);
  }
  EXPECT_GT(lowest, 4.9);
  EXPECT_NEAR(loop.windings.q, 5, 0.05);
}

TEST(CurrentController, AtRestWithoutVoltageItIsFinite) {
  BlockUnderTest block(
      "CurrentController",
      R"({"resistance": 0.8, "inductance_d": 0.003, "inductance_q": 0.003, "bandwidth": 1000})", sample_time);
  block.evaluate();
  block.update();
  EXPECT_EQ(block.output("voltage_d"), 0);
  EXPECT_EQ(block.output("voltage_q"), 0);
}

}  // namespace
}  // namespace loopwright::current_controller_test
