#include <gmock/gmock.h>
#include "tests/blocks/frequency_response.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::continuous_pi_controller_test {
namespace {

TEST(ContinuousPiController, HasItsTransferFunction) {
  for (double w : {0.5, 5.0, 100.0}) {
    BlockUnderTest block("ContinuousPiController", R"({"Kp": 3, "Ki": 7, "b": 0.4})");
    const Complex s(0, w);
    EXPECT_COMPLEX_NEAR(continuous_response(block, "reference", "command", w), 3 * 0.4 + 7.0 / s, 1e-12);
    block.input("reference") = 0;
    EXPECT_COMPLEX_NEAR(continuous_response(block, "measured", "command", w), -3.0 - 7.0 / s, 1e-12);
  }
}

/// An error of 1 for two seconds, then of -1. Returns how long the command stays at its limit of 2 after
/// that.
double time_to_leave_the_limit(const std::string& anti_windup) {
  const RunResult result = run_of(diagram(
      R"("error": {"type": "Step", "time": 2, "before": 1, "after": -1}, "zero": {"type": "Constant", "value": 0},
         "pi": {"type": "ContinuousPiController", "Kp": 1, "Ki": 5, "low": -2, "high": 2, )" +
          anti_windup +
          R"(, "in": {"reference": "error.y", "measured": "zero.y"}},
         "at_limit": {"type": "Comparison", "operator": ">=", "in": {"a": "pi.command", "b": "two.y"}},
         "two": {"type": "Constant", "value": 2}, "late": {"type": "Step", "time": 2},
         "both": {"type": "Logic", "operator": "and", "in": {"terms": ["at_limit.y", "late.y"]}},
         "rate": {"type": "Gain", "gain": {"value": 1, "unit": "1/s"}, "in": {"u": "both.y"}},
         "time": {"type": "Integrator", "in": {"u": "rate.y"}})",
      R"("method": "dopri5", "stop": 6, "relative_tolerance": 1e-9)"));
  EXPECT_EQ(result.message, "");
  return signal(result, "time.y").back();
}

TEST(ContinuousPiController, WindsUpWithoutAProtectionAndNotWithOne) {
  // The integral reaches 10; the command leaves 2 where the integral has fallen to 2 + 1, after 7/5 s.
  EXPECT_NEAR(time_to_leave_the_limit(R"("anti_windup": "none")"), 7.0 / 5, 1e-8);
  EXPECT_NEAR(time_to_leave_the_limit(R"("anti_windup": "clamping")"), 0, 1e-8);
  // Settled, the excess is Ki e / tracking_gain = 5/20: it ends below the limit as soon as the error has
  // turned.
  EXPECT_NEAR(time_to_leave_the_limit(R"("anti_windup": "back_calculation", "tracking_gain": 20)"), 0, 1e-8);
}

TEST(ContinuousPiController, BackCalculationFollowsItsEquation) {
  // While v > high: I' = Ki e + g (high - Kp e - I), so that I → high - Kp e + Ki e / g with the rate g.
  const RunResult result = run_of(diagram(
      R"("one": {"type": "Constant", "value": 1}, "zero": {"type": "Constant", "value": 0},
         "pi": {"type": "ContinuousPiController", "Kp": 1, "Ki": 5, "high": 2, "initial": 4, "anti_windup": "back_calculation",
                "tracking_gain": 3, "in": {"reference": "turn.y", "measured": "zero.y"}},
         "turn": {"type": "Step", "time": 1.5, "before": 1, "after": 0})",
      R"("method": "dopri5", "stop": 1.5, "relative_tolerance": 1e-10, "absolute_tolerance": 1e-12)"));
  const double settled = 2 - 1 + 5.0 / 3;
  EXPECT_NEAR(signal(result, "pi.command").back(), std::min(2.0, settled + (4 - settled) * std::exp(-4.5)),
              1e-8);
}

TEST(ContinuousPiController, ClampingDoesNotChatterWhereErrorAndIntegralPullTheLimitFromBothSides) {
  // The error falls slowly: Ki e drives the command up faster than Kp e' draws it down.
  const RunResult result = run_of(diagram(
      R"("fall": {"type": "Ramp", "slope": -0.2, "initial": 1}, "zero": {"type": "Constant", "value": 0},
         "pi": {"type": "ContinuousPiController", "Kp": 2, "Ki": 5, "low": -2, "high": 2,
                "in": {"reference": "fall.y", "measured": "zero.y"}})",
      R"("method": "dopri5", "stop": 10, "record_step": 0.01)"));
  EXPECT_EQ(result.message, "");
  const auto& command = signal(result, "pi.command");
  for (size_t i = 1; i < 460; ++i) EXPECT_EQ(command[i], 2) << "at row " << i;
  // At 4.6 s Ki e = -Kp e': from then on v falls from the limit, or a hundredth above: v' = 5 e - 0.4.
  const auto fallen = [](double after) { return 0.5 * after * after; };
  EXPECT_NEAR(command[560], 2 - fallen(1), 0.0201);
  EXPECT_NEAR(command[600], command[560] + fallen(1) - fallen(1.4), 1e-6);
}

TEST(ContinuousPiController, RefusesWhatCannotWork) {
  const auto text = [](const char* rest) {
    return BlockUnderTest("ContinuousPiController", R"({"Kp": 1, "Ki": 1, )" + std::string(rest) + "}")
        .problems()
        .text();
  };
  EXPECT_THAT(text(R"("low": 1, "high": 1)"), testing::HasSubstr("low < high"));
  EXPECT_THAT(text(R"("anti_windup": "back_calculation")"), testing::HasSubstr("Ki/Kp"));
}

}  // namespace
}  // namespace loopwright::continuous_pi_controller_test
