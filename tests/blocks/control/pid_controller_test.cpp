#include <gmock/gmock.h>
#include "tests/blocks/frequency_response.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::pid_controller_test {
namespace {

constexpr double T = 0.01;

TEST(PidController, IsTheTustinImageOfItsFormula) {
  BlockUnderTest block("PidController",
                       R"({"Kp": 3, "Ki": 0, "Kd": 0.4, "derivative_pole": 60, "b": 0.5, "c": 0.2})", T);
  for (double w : {0.0, 5.0, 100.0}) {
    const Complex s = tustin(w, T), slope = 60.0 * s / (s + 60.0);
    EXPECT_COMPLEX_NEAR(sampled_response(block, "reference", "command", w, T), 1.5 + 0.4 * 0.2 * slope,
                        1e-11);
    EXPECT_COMPLEX_NEAR(sampled_response(block, "measured", "command", w, T), -3.0 - 0.4 * slope, 1e-11);
  }
}

TEST(PidController, IntegratesTheErrorByTrapezoids) {
  BlockUnderTest block("PidController",
                       R"({"Kp": 0, "Ki": 7, "Kd": 0, "derivative_pole": 60, "initial": 1.5})", T);
  double integral = 1.5, last = 0;
  for (int k = 0; k < 100; ++k) {
    const double error = std::cos(0.3 * k);
    integral += 7 * T / 2 * (error + last), last = error;
    EXPECT_NEAR(block.sample("reference", error, "command"), integral, 1e-13);
  }
}

/// Steps with an error of 1 for two seconds, then of -1. Returns how long the command stays at its limit
/// after the change.
int samples_to_leave_the_limit(const std::string& anti_windup) {
  BlockUnderTest block(
      "PidController",
      R"({"Kp": 1, "Ki": 5, "Kd": 0, "derivative_pole": 60, "low": -2, "high": 2, )" + anti_windup + "}", T);
  for (int k = 0; k < 200; ++k) EXPECT_LE(block.sample("reference", 1, "command"), 2);
  EXPECT_EQ(block.output("command"), 2);
  for (int k = 0; k < 1000; ++k)
    if (block.sample("reference", -1, "command") < 2) return k;
  return 1000;
}

TEST(PidController, WindsUpWithoutAProtectionAndNotWithOne) {
  // The integral reaches 10; to fall below 2 + 1 takes 7 / 5 s. The trapezoid over the turn adds nothing.
  EXPECT_NEAR(samples_to_leave_the_limit(R"("anti_windup": "none")"), 140, 2);
  EXPECT_EQ(samples_to_leave_the_limit(R"("anti_windup": "clamping")"), 0);
  EXPECT_EQ(samples_to_leave_the_limit(R"("anti_windup": "back_calculation", "tracking_gain": 20)"), 0);
}

TEST(PidController, BackCalculationSettlesWhereTrackingBalancesTheError) {
  BlockUnderTest block("PidController", R"({"Kp": 1, "Ki": 5, "Kd": 0, "derivative_pole": 60, "high": 2,
                                            "anti_windup": "back_calculation", "tracking_gain": 20})",
                       T);
  for (int k = 0; k < 500; ++k) block.sample("reference", 1, "command");
  // In the steady state a sample adds Ki T to the integral and tracking removes (1 - e^(-20 T)) · excess, so
  // that both are equal. The integral is then limit + excess - Kp · 1. Without the error the command shows
  // the integral.
  const double excess = 5 * T / (1 - std::exp(-20 * T)), integral_after = 2 + excess - 1 - 5 * T;
  EXPECT_NEAR(block.sample("reference", 0, "command"), integral_after + 5 * T / 2, 1e-12);
}

TEST(PidController, ClampingStillLetsTheIntegralComeBack) {
  BlockUnderTest block("PidController",
                       R"({"Kp": 0, "Ki": 5, "Kd": 0, "derivative_pole": 60, "high": 2, "initial": 3})", T);
  EXPECT_EQ(block.sample("reference", -1, "command"), 2);
  for (int k = 0; k < 30; ++k) block.sample("reference", -1, "command");
  EXPECT_LT(block.output("command"), 2);
}

TEST(PidController, HasTheDifferenceEquationsOfItsMethod) {
  // s is replaced by (z-1)/T forward and (z-1)/(T z) backward; the responses follow from that alone.
  for (const std::string method : {"forward", "backward"}) {
    BlockUnderTest block("PidController",
                         R"({"Kp": 3, "Ki": 0, "Kd": 0.4, "derivative_pole": 60, "b": 0.5, "c": 0.2,
                                              "method": ")" +
                             method + "\"}",
                         T);
    for (double w : {0.0, 5.0, 100.0, 250.0}) {
      const Complex z = std::polar(1.0, w * T), s = method == "forward" ? (z - 1.0) / T : (z - 1.0) / (T * z);
      const Complex slope = 60.0 * s / (s + 60.0);
      EXPECT_COMPLEX_NEAR(sampled_response(block, "reference", "command", w, T), 1.5 + 0.4 * 0.2 * slope,
                          1e-11);
      EXPECT_COMPLEX_NEAR(sampled_response(block, "measured", "command", w, T), -3.0 - 0.4 * slope, 1e-11);
    }
  }
}

TEST(PidController, IntegratesByTheRuleOfItsMethod) {
  for (const std::string method : {"forward", "backward"}) {
    BlockUnderTest block("PidController",
                         R"({"Kp": 0, "Ki": 7, "Kd": 0, "derivative_pole": 60, "initial": 1.5,
                                              "method": ")" +
                             method + "\"}",
                         T);
    double integral = 1.5, last = 0;
    for (int k = 0; k < 100; ++k) {
      const double error = std::cos(0.3 * k);
      integral += 7 * T * (method == "forward" ? last : error), last = error;
      EXPECT_NEAR(block.sample("reference", error, "command"), integral, 1e-13) << method << " at " << k;
    }
  }
}

TEST(PidController, ADerivativeBeginsWithTheChangeFromTheInitialMeasurement) {
  for (const double c : {0.0, 1.0}) {
    const auto first_command = [&](double initial_measured) {
      BlockUnderTest block(
          "PidController",
          fmt::format(
              R"({{"Kp": 0, "Ki": 0, "Kd": 1, "derivative_pole": 60, "c": {}, "initial_measured": {}}})", c,
              initial_measured),
          T);
      block.input("reference") = 293;
      return block.sample("measured", 293, "command");
    };
    // At rest at 293 nothing changes. From 0 the slope of c r - y acts: 2 ω/(2 + ωT) times its change.
    EXPECT_EQ(first_command(293), 0);
    EXPECT_NEAR(first_command(0), (c - 1) * 293 * 2 * 60 / (2 + 60 * T), 1e-9);
  }
}

TEST(PidController, AnUnstableForwardRuleIsRefusedAtTheStart) {
  const std::string text = R"("c": {"type": "Constant", "value": 1},
      "pid": {"type": "PidController", "Kp": 1, "Ki": 1, "Kd": 1, "derivative_pole": 250, "method": "forward", "sample_time": 0.01,
              "in": {"reference": "c.y", "measured": "c.y"}})";
  EXPECT_THAT(run_of(diagram(text)).message, testing::HasSubstr("the forward rule is unstable"));
}

TEST(PidController, RefusesWhatCannotWork) {
  const auto text = [](const char* rest) {
    return BlockUnderTest("PidController",
                          R"({"Kp": 1, "Ki": 1, "Kd": 1, "derivative_pole": 9, )" + std::string(rest) + "}",
                          T)
        .problems()
        .text();
  };
  EXPECT_THAT(text(R"("low": 1, "high": 1)"), testing::HasSubstr("low < high"));
  EXPECT_THAT(text(R"("anti_windup": "back_calculation")"), testing::HasSubstr("Ki/Kp"));
  EXPECT_THAT(text(R"("anti_windup": "conditional")"), testing::HasSubstr("clamping"));
}

}  // namespace
}  // namespace loopwright::pid_controller_test
