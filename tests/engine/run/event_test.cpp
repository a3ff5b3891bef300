// Events of diagrams: located exactly, each decided once, counted by name; chattering is reported.
#include <gtest/gtest.h>
#include <cmath>
#include <ctime>
#include "tests/engine/written_diagram.h"

namespace loopwright::event_test {
namespace {

int64_t events(const RunResult& result, std::string_view name) {
  for (const CrossingCount& crossing : result.statistics.events)
    if (crossing.name == name) return crossing.events;
  return 0;
}

constexpr std::string_view tight = R"("relative_tolerance": 1e-11, "absolute_tolerance": 1e-13)";

/// A ball dropped from 1 m that keeps 0.8 of its speed at every bounce. `bounces` counts them, `last` stores
/// the time.
std::string ball(std::string_view solver) {
  return diagram(R"("gravity": {"type": "Constant", "value": {"value": -9.81, "unit": "m/s^2"}},
    "velocity": {"type": "Integrator", "in": {"u": "gravity.y", "reset": "below.y", "reset_value": "rebound.y"}},
    "height": {"type": "Integrator", "initial": {"value": 1, "unit": "m"}, "in": {"u": "velocity.y"}},
    "below": {"type": "Gain", "gain": {"value": -1, "unit": "1"}, "in": {"u": "height.y"}},
    "rebound": {"type": "Gain", "gain": {"value": -0.8, "unit": "1"}, "in": {"u": "velocity.y"}},
    "zero": {"type": "Constant", "value": {"value": 0, "unit": "s"}}, "one": {"type": "Constant", "value": {"value": 1, "unit": "1"}},
    "since": {"type": "Integrator", "in": {"u": "one.y", "reset": "below.y", "reset_value": "zero.y"}})",
                 solver, R"(, "log": ["height.y", "velocity.y", "since.y"])");
}

TEST(RunEvents, ABallBouncesAtTheTimesOfItsClosedForm) {
  // `since` is the time since the last bounce: at every row, time - since is the time of that bounce.
  for (const char* method : {"dopri5", "cvode-bdf"}) {
    const RunResult result =
        run_of(ball(fmt::format(R"("stop": 3.6, "method": "{}", {}, "record_step": 0.01)", method, tight)));
    ASSERT_EQ(result.status, RunStatus::finished) << method << result.message;
    std::vector<double> found;
    for (size_t i = 0; i < result.recording.rows(); ++i) {
      const double bounce = signal(result, "time")[i] - signal(result, "since.y")[i];
      if (bounce > 1e-6 && (found.empty() || bounce > found.back() + 1e-6)) found.push_back(bounce);
      EXPECT_GE(signal(result, "height.y")[i], -1e-9) << method;
    }
    ASSERT_GE(found.size(), 10u) << method;
    const double fall = std::sqrt(2 / 9.81);
    double bounce = fall;
    for (int k = 0; k < 10; ++k) {
      EXPECT_NEAR(found[size_t(k)], bounce, 1e-9) << method << " bounce " << k;
      bounce += 2 * fall * std::pow(0.8, k + 1);
    }
  }
}

TEST(RunEvents, ARelayOscillatesWithThePeriodOfItsClosedForm) {
  // dx/dt = relay(x) = -1 when on, +1 when off, on above 0.2, off below -0.2: a triangle wave of period 0.8.
  for (const char* method : {"dopri5", "cvode-bdf", "cvode-adams"}) {
    const RunResult result = run_of(diagram(
        R"("x": {"type": "Integrator", "in": {"u": "r.y"}}, "r": {"type": "Relay", "switch_on": 0.2, "switch_off": -0.2, "on": -1, "off": 1, "in": {"u": "x.y"}})",
        fmt::format(R"("stop": 80, "method": "{}", "record_step": 0.05)", method)));
    ASSERT_EQ(result.status, RunStatus::finished) << method << result.message;
    EXPECT_EQ(events(result, "r.threshold"), 200) << method << ": at 0.2, 0.6, 1.0 … 79.8";
    for (size_t i = 0; i < result.recording.rows(); ++i) {
      const double phase = std::fmod(signal(result, "time")[i] + 0.2, 0.8);
      EXPECT_NEAR(signal(result, "x.y")[i], phase < 0.4 ? phase - 0.2 : 0.6 - phase, 1e-10)
          << method << " row " << i;
    }
  }
}

TEST(RunEvents, ARelayBehindALagOscillatesWithThePeriodOfItsClosedForm) {
  // dx/dt = u - x, u = ±1, thresholds ±h: half a period is ln((1 + h)/(1 - h)).
  const double h = 0.25, half = std::log((1 + h) / (1 - h));
  const RunResult result = run_of(diagram(
      R"("x": {"type": "StrictlyProperTransferFunction", "numerator": [1], "denominator": [1, 1], "in": {"u": "r.y"}},
    "r": {"type": "Relay", "switch_on": 0.25, "switch_off": -0.25, "on": -1, "off": 1, "in": {"u": "x.y"}})",
      fmt::format(R"("stop": 50, "method": "dopri5", {}, "record_step": 0.5)", tight)));
  const double first = std::log(1 / (1 - h));  // from rest up to the first threshold
  EXPECT_EQ(events(result, "r.threshold"), 1 + int64_t((50 - first) / half));
  const double since = std::fmod(50 - first, half), side = int64_t((50 - first) / half) % 2 ? 1 : -1;
  EXPECT_NEAR(signal(result, "x.y").back(), side * (1 - (1 + h) * std::exp(-since)), 1e-8);
}

TEST(RunEvents, OfOneInstantComeAsOneSet) {
  // Three switches on the same signal, and one on its double, at the same instant: the sum never shows a
  // partial change.
  const RunResult result = run_of(diagram(
      R"("t": {"type": "Clock"}, "x": {"type": "Integrator", "in": {"u": "one.y"}}, "one": {"type": "Constant", "value": 1},
    "twice": {"type": "Gain", "gain": 2, "in": {"u": "x.y"}},
    "a": {"type": "Relay", "switch_on": 0.7, "switch_off": 0, "in": {"u": "x.y"}}, "b": {"type": "Relay", "switch_on": 0.7, "switch_off": 0, "in": {"u": "x.y"}},
    "c": {"type": "Relay", "switch_on": 1.4, "switch_off": 0, "in": {"u": "twice.y"}}, "sum": {"type": "Sum", "in": {"terms": ["a.y", "b.y", "c.y"]}})",
      R"("stop": 1, "method": "dopri5", "record_step": 0.01)"));
  EXPECT_EQ(events(result, "a.threshold"), 1);
  EXPECT_EQ(events(result, "b.threshold"), 1);
  EXPECT_EQ(events(result, "c.threshold"), 1);
  for (double sum : signal(result, "sum.sum")) EXPECT_TRUE(sum == 0 || sum == 3) << sum;
}

TEST(RunEvents, ChatteringIsNoticedAtOnceAndNamed) {
  for (const char* method : {"dopri5", "cvode-bdf", "cvode-adams"}) {
    const auto started = std::clock();
    const RunResult result = run_of(diagram(
        R"("x": {"type": "Integrator", "initial": 1, "in": {"u": "push.y"}}, "sign": {"type": "Sign", "in": {"u": "x.y"}},
      "push": {"type": "Gain", "gain": -1, "in": {"u": "sign.y"}})",
        fmt::format(R"("stop": 1000, "method": "{}", "record_step": 0.01)", method)));
    EXPECT_LT(double(std::clock() - started) / CLOCKS_PER_SEC, 1.0) << method;
    EXPECT_EQ(result.status, RunStatus::failed) << method;
    EXPECT_NEAR(result.time, 1, 1e-6) << method;
    EXPECT_TRUE(has(result.message, "chattering: \"sign.")) << method << ": " << result.message;
    EXPECT_TRUE(has(result.message, "hysteresis")) << result.message;
    EXPECT_EQ(result.recording.rows(), 101u) << "what was computed before is kept";
  }
}

TEST(RunEvents, AHysteresisAsAdvisedEndsTheChattering) {
  const RunResult result = run_of(diagram(
      R"("x": {"type": "Integrator", "initial": 1, "in": {"u": "r.y"}}, "r": {"type": "Relay", "switch_on": 0.01, "switch_off": -0.01, "on": -1, "off": 1, "in": {"u": "x.y"}})",
      R"("stop": 5, "method": "dopri5", "record_step": 0.01)"));
  EXPECT_EQ(result.status, RunStatus::finished) << result.message;
}

TEST(RunEvents, ASwitchThatIsLeftOnTheSideItCameFromIsDecidedAnew) {
  // x falls through zero, is pushed back through it at once, and stays: the sign must be +1 again, not -1
  // permanently. dx/dt = -1 until x < 0 was detected, +1 from then on.
  const RunResult result = run_of(diagram(R"("x": {"type": "Integrator", "initial": 1, "in": {"u": "r.y"}},
    "r": {"type": "Relay", "switch_on": 1000, "switch_off": 0, "on": -1, "off": 1, "starts_on": true, "in": {"u": "x.y"}}, "sign": {"type": "Sign", "in": {"u": "x.y"}})",
                                          R"("stop": 3, "method": "dopri5", "record_step": 0.1)"));
  ASSERT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_NEAR(signal(result, "x.y").back(), 2, 1e-12);
  EXPECT_EQ(signal(result, "sign.y").back(), 1);
}

TEST(RunEvents, LimitsOfAnIntegratorHoldAndRelease) {
  // u = cos(t): the integral would be sin(t), limited to ±0.5. It leaves a limit when u changes its sign.
  const RunResult result = run_of(diagram(
      R"("u": {"type": "Sine", "frequency": "=0.5/pi", "phase": "=pi/2"}, "x": {"type": "Integrator", "low": -0.5, "high": 0.5, "in": {"u": "u.y"}})",
      fmt::format(R"("stop": 10, "method": "dopri5", {}, "record_step": 0.01)", tight)));
  for (size_t i = 0; i < result.recording.rows(); ++i) {
    const double t = signal(result, "time")[i];
    const auto half_turns = int64_t(t / M_PI + 0.5);  // times that u has changed its sign
    const double expected = half_turns == 0  ? std::min(std::sin(t), 0.5)
                            : half_turns % 2 ? std::max(std::sin(t) - 0.5, -0.5)
                                             : std::min(std::sin(t) + 0.5, 0.5);
    EXPECT_NEAR(signal(result, "x.y")[i], expected, 1e-9) << t;
  }
}

TEST(Events, WhatCannotCrossWithItsParametersIsNotWatched) {
  const auto crossings = [](double coulomb, double resolution) {
    return plan_of(diagram(fmt::format(R"("r": {{"type": "Sine", "amplitude": 1, "frequency": 1}},
      "f": {{"type": "MotionFeedforward", "mass": 1, "damping": 1, "coulomb": {}, "in": {{"velocity": "r.y", "acceleration": "r.y"}}}},
      "e": {{"type": "Encoder", "resolution": {}, "in": {{"position": "r.y"}}}})",
                                       coulomb, resolution),
                           R"("method": "dopri5", "stop": 1)"))
        ->crossings.size();
  };
  EXPECT_EQ(crossings(0, 0), 0u);
  EXPECT_EQ(crossings(0.5, 0), 2u);
  EXPECT_EQ(crossings(0, 0.1), 1u);
}

}  // namespace
}  // namespace loopwright::event_test
