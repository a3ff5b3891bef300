#include <gmock/gmock.h>
#include <cmath>
#include "tests/blocks/block_under_test.h"

namespace loopwright::scheduled_pid_controller_test {
namespace {

constexpr double T = 0.01;

/// The block, and the PidController with the gains of its begin.
struct Pair {
  explicit Pair(const std::string& settings, const std::string& of_scheduled = "")
      : scheduled("ScheduledPidController", "{\"derivative_pole\": 40" + settings + of_scheduled + "}", T),
        plain("PidController", R"({"Kp": 3, "Ki": 8, "Kd": 0.2, "derivative_pole": 40)" + settings + "}", T) {
    scheduled.input("Kp") = 3, scheduled.input("Ki") = 8, scheduled.input("Kd") = 0.2;
  }
  void sample(double reference, double measured) {
    for (BlockUnderTest* block : {&scheduled, &plain}) {
      block->input("reference") = reference, block->input("measured") = measured;
      block->evaluate();
    }
  }
  void update() { scheduled.update(), plain.update(); }
  BlockUnderTest scheduled, plain;
};

TEST(ScheduledPidController, WithConstantGainsIsThePidController) {
  for (const char* settings :
       {"", R"(, "b": 0.4, "c": 0, "initial": 2, "initial_measured": 0.5)", R"(, "low": -2, "high": 3)",
        R"(, "low": -2, "high": 3, "anti_windup": "back_calculation", "tracking_gain": 5)",
        R"(, "low": -2, "high": 3, "anti_windup": "none")"}) {
    Pair pair(settings);
    for (int k = 0; k < 300; ++k) {
      pair.sample(std::sin(0.05 * k), 0.3 * std::cos(0.11 * k));
      ASSERT_NEAR(pair.scheduled.output("command"), pair.plain.output("command"), 1e-12)
          << settings << " at " << k;
      pair.update();
    }
  }
}

TEST(ScheduledPidController, AChangeOfGainsDoesNotMoveTheCommand) {
  Pair pair("");
  for (int k = 0; k < 100; ++k) pair.sample(1, std::sin(0.02 * k)), pair.update();
  const double last = pair.scheduled.output("command");
  pair.scheduled.input("Kp") = 30, pair.scheduled.input("Kd") = 1, pair.scheduled.input("Ki") = 0;
  pair.sample(1, std::sin(0.02 * 99));  // the same signals as before
  // The filtered derivative decays by one sample: D (2 - ωT)/(2 + ωT), with the new Kd = 1.
  const double decay = (2 - 0.4) / (2 + 0.4);
  double D = 0, signal = 0;
  for (int k = 0; k < 100; ++k) {
    const double now = 1 - std::sin(0.02 * k);
    D = decay * D + 2 * 40 / 2.4 * (now - signal), signal = now;
  }
  EXPECT_NEAR(pair.scheduled.output("command"), last + 1 * (decay - 1) * D, 1e-12);
}

TEST(ScheduledPidController, ReturnsFromManualModeWithoutABump) {
  for (const double Ki : {0.0, 8.0}) {
    Pair pair(R"(, "low": -5, "high": 5)");
    pair.scheduled.input("Ki") = Ki, pair.scheduled.input("Kd") = 0;
    pair.sample(1, 0), pair.update();
    pair.scheduled.input("manual") = 1;
    for (const double manual : {-1.0, 2.5, 9.0, 4.0}) {
      pair.scheduled.input("manual_command") = manual;
      pair.sample(1, 0.4);
      EXPECT_EQ(pair.scheduled.output("command"), std::min(manual, 5.0));
      pair.update();
    }
    pair.scheduled.input("manual") = 0;
    pair.sample(1, 0.4);
    EXPECT_NEAR(pair.scheduled.output("command"), 4 + Ki * T * 0.6, 1e-12);
  }
}

TEST(ScheduledPidController, HoldsTheLastAutomaticCommand) {
  Pair pair("", R"(, "in_manual": "holds")");
  pair.sample(1, 0.2), pair.update();
  const double last = pair.scheduled.output("command");
  pair.scheduled.input("manual") = 1;
  for (int k = 0; k < 5; ++k) {
    pair.sample(-3, k);
    EXPECT_EQ(pair.scheduled.output("command"), last);
    pair.update();
  }
  pair.scheduled.input("manual") = 0, pair.scheduled.input("Ki") = 0, pair.scheduled.input("Kd") = 0;
  pair.sample(-3, 4);
  EXPECT_NEAR(pair.scheduled.output("command"), last, 1e-12);
}

TEST(ScheduledPidController, RefusesLimitsWithoutRoom) {
  BlockUnderTest block("ScheduledPidController", R"({"derivative_pole": 4, "low": 1, "high": 0})", T);
  EXPECT_THAT(block.problems().text(), testing::HasSubstr("low < high"));
}

}  // namespace
}  // namespace loopwright::scheduled_pid_controller_test
