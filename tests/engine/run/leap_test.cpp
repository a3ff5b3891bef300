// Sources with a period that steps must resolve, and the warning if an event was missed.
#include <gtest/gtest.h>
#include "tests/engine/written_diagram.h"

namespace loopwright::leap_test {
namespace {

/// An integrator of 1 that a sine of 1 Hz resets to 0: it never exceeds 1.
std::string reset_by_sine(std::string_view solver,
                          std::string_view source = R"("Sine", "frequency": 1, "phase": 0.3)") {
  return diagram(
      fmt::format(
          R"("one": {{"type": "Constant", "value": 1}}, "s": {{"type": {}}}, "z": {{"type": "Constant", "value": 0}},
    "i": {{"type": "Integrator", "in": {{"u": "one.y", "reset": "s.y", "reset_value": "z.y"}}}})",
          source),
      solver, R"(, "log": ["i.y", "s.y"])");
}
std::string all(const std::vector<std::string>& lines) { return fmt::format("{}", fmt::join(lines, "\n")); }

TEST(Leap, NoResetByASineIsMissed) {
  for (const char* method : {"dopri5", "cvode-bdf", "cvode-adams"})
    for (const double stop : {2.05, 10.05, 100.0, 1000.0}) {
      const RunResult result = run_of(
          reset_by_sine(fmt::format(R"("method": "{}", "stop": {}, "record_step": 0.05)", method, stop)));
      ASSERT_EQ(result.status, RunStatus::finished) << result.message;
      for (size_t row = 0; row < result.recording.rows(); ++row) {
        // The sine with phase 0.3 rises through zero at k - 0.3/2π.
        const double phase = signal(result, "time")[row] + 0.3 / (2 * M_PI);
        const double since = phase < 1 ? signal(result, "time")[row] : phase - std::floor(phase);
        ASSERT_NEAR(std::remainder(signal(result, "i.y")[row] - since, 1), 0, 1e-6) << method;
        ASSERT_LE(signal(result, "i.y")[row], 1 + 1e-6) << method << " row " << row;
      }
      EXPECT_EQ(all(result.warnings), "") << method;
    }
}

TEST(Leap, SourcesWithTheirOwnPeriodKeepStepsShort) {
  for (const char* source : {R"("Chirp", "from": 0.5, "to": 2, "duration": 200)",
                             R"("Multisine", "components": [{"frequency": 1, "amplitude": 1}])"}) {
    const RunResult result =
        run_of(reset_by_sine(R"("method": "dopri5", "stop": 100, "record_step": 0.05)", source));
    ASSERT_EQ(result.status, RunStatus::finished) << result.message;
    for (size_t row = 0; row < result.recording.rows(); ++row)
      ASSERT_LE(signal(result, "i.y")[row], 2.01) << source << " row " << row;
  }
}

TEST(Leap, OverSignChangesThatWereNoticedIsWarnedOf) {
  const RunResult result =
      run_of(reset_by_sine(R"("method": "dopri5", "stop": 1000, "record_step": 1, "maximum_step": 50)"));
  ASSERT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_TRUE(has(all(result.warnings), "\"i.reset\" went through zero and back within one step") &&
              has(all(result.warnings), "maximum_step"))
      << all(result.warnings);
}

TEST(Leap, OfNothingIsNotWarnedOf) {
  const char* const ball = R"("gravity": {"type": "Constant", "value": {"value": -9.81, "unit": "m/s^2"}},
    "velocity": {"type": "Integrator", "in": {"u": "gravity.y", "reset": "below.y", "reset_value": "rebound.y"}},
    "height": {"type": "Integrator", "initial": {"value": 1, "unit": "m"}, "in": {"u": "velocity.y"}},
    "below": {"type": "Gain", "gain": {"value": -1, "unit": "1"}, "in": {"u": "height.y"}},
    "rebound": {"type": "Gain", "gain": {"value": -0.8, "unit": "1"}, "in": {"u": "velocity.y"}})";
  const char* const relay = R"("x": {"type": "Integrator", "in": {"u": "r.y"}},
    "r": {"type": "Relay", "switch_on": 0.2, "switch_off": -0.2, "on": -1, "off": 1, "in": {"u": "x.y"}})";
  for (const char* blocks : {ball, relay})
    for (const char* method : {"dopri5", "cvode-bdf"}) {
      const RunResult result = run_of(diagram(blocks, fmt::format(R"("stop": 3.6, "method": "{}")", method)));
      ASSERT_EQ(result.status, RunStatus::finished) << result.message;
      EXPECT_EQ(all(result.warnings), "") << method;
    }
}

TEST(Leap, AFixedStepOrSampleTimeBeyondHalfAPeriodIsWarnedOf) {
  const auto warnings = [](std::string_view blocks, std::string_view solver) {
    return all(run_of(diagram(blocks, solver)).warnings);
  };
  const char* const sine =
      R"("s": {"type": "Sine", "frequency": 10}, "x": {"type": "Integrator", "in": {"u": "s.y"}})";
  EXPECT_TRUE(has(warnings(sine, R"("stop": 10, "step": 0.06)"), "\"s\" has a period of 0.1 s"));
  EXPECT_EQ(warnings(sine, R"("stop": 10, "step": 0.01)"), "");
  EXPECT_EQ(warnings(sine, R"("stop": 10, "method": "dopri5", "record_step": 1)"), "");
  EXPECT_TRUE(has(warnings(R"("s": {"type": "Sine", "frequency": 10, "sample_time": 0.06})", R"("stop": 6)"),
                  "\"sample_time\""));
}

TEST(Leap, ASampleTimeBeyondATenthOfTheRunIsWarnedOf) {
  const auto text = [](std::string_view time, std::string_view stop) {
    return problems_of(
        diagram(fmt::format(R"("z": {{"type": "ZeroOrderHold", "sample_time": {}, "in": {{"u": "t.time"}}}},
          "other": {{"type": "ZeroOrderHold", "sample_time": {}, "in": {{"u": "t.time"}}}}, "t": {{"type": "Clock"}})",
                            time, time),
                fmt::format(R"("stop": {})", stop)));
  };
  const std::string once = text("1", "2");
  EXPECT_TRUE(has(once, "warning: a sample time of 1 s in a run of 2 s") && has(once, "another unit"))
      << once;
  EXPECT_EQ(once.find("a sample time of"), once.rfind("a sample time of"))
      << "each sample time is named once";
  EXPECT_EQ(text("0.1", "1"), "");
  EXPECT_EQ(text("0.001", "2"), "");
}

TEST(LongRuns, WithoutSamplesReachATrillionSeconds) {
  // dx/dt = -x/1e11 from 1.
  for (const char* method : {"dopri5", "cvode-bdf"}) {
    const RunResult result = run_of(diagram(
        R"("x": {"type": "Integrator", "initial": 1, "in": {"u": "g.y"}}, "g": {"type": "Gain", "gain": {"value": -1e-11, "unit": "1/s"}, "in": {"u": "x.y"}})",
        fmt::format(
            R"("stop": 1e12, "method": "{}", "relative_tolerance": 1e-9, "absolute_tolerance": 1e-15)",
            method)));
    ASSERT_EQ(result.status, RunStatus::finished) << result.message;
    EXPECT_EQ(result.time, 1e12);
    EXPECT_NEAR(signal(result, "x.y").back() / std::exp(-10.0), 1, 1e-6) << method;
  }
  EXPECT_EQ(run_of(diagram(R"("t": {"type": "Clock"})", R"("stop": 1e12, "step": 1e9)")).time, 1e12);
}

TEST(LongRuns, RobertsonAgreesWithPublishedValues) {
  // E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, ROBER at t = 1e11.
  const RunResult result = run_of(diagram(
      R"json("a": {"type": "Integrator", "initial": 1, "in": {"u": "da.y"}}, "b": {"type": "Integrator", "in": {"u": "db.y"}}, "c": {"type": "Integrator", "in": {"u": "dc.y"}},
    "da": {"type": "Expression", "formula": "-0.04*a+1e4*b*c", "names": ["a", "b", "c"], "in": {"arguments": ["a.y", "b.y", "c.y"]}},
    "db": {"type": "Expression", "formula": "0.04*a-1e4*b*c-3e7*b*b", "names": ["a", "b", "c"], "in": {"arguments": ["a.y", "b.y", "c.y"]}},
    "dc": {"type": "Expression", "formula": "3e7*b*b", "names": ["b"], "in": {"arguments": ["b.y"]}})json",
      R"("stop": 1e11, "method": "cvode-bdf", "relative_tolerance": 1e-9, "absolute_tolerance": 1e-22, "record_step": 1e9)"));
  ASSERT_EQ(result.status, RunStatus::finished) << result.message;
  EXPECT_NEAR(signal(result, "a.y").back() / 0.2083340149701255e-07, 1, 1e-5);
  EXPECT_NEAR(signal(result, "b.y").back() / 0.8333360770334713e-13, 1, 1e-5);
  EXPECT_NEAR(signal(result, "c.y").back(), 0.9999999791665050, 1e-8);
}

}  // namespace
}  // namespace loopwright::leap_test
