#include "tools/linearize/analysis.h"
#include <gmock/gmock.h>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include "engine/run/require_finished.h"
#include "models/linear/frequency_response.h"
#include "tests/engine/written_diagram.h"
#include "tools/linearize/nyquist.h"

namespace loopwright::analysis_test {
namespace {

using std::numbers::pi;
using testing::HasSubstr;

/// A held PD controller on a mass: 100 rad/s, T = 2 ms, one sample of computing time.
const char* const servo = R"(
  "reference": {"type": "Constant", "value": 0},
  "sensor": {"type": "ZeroOrderHold", "sample_time": 0.002, "in": {"u": "mass.position"}},
  "feedback": {"type": "PdController", "sample_time": 0.002, "Kp": 400, "Kd": 28, "derivative_pole": 500,
               "in": {"reference": "reference.y", "measured": "sensor.y"}},
  "late": {"type": "UnitDelay", "sample_time": 0.002, "in": {"u": "feedback.command"}},
  "mass": {"type": "Mass", "mass": 1, "in": {"force": "late.y"}})";

LinearAnalysis analyse_servo(const LinearizeRequest& request) {
  const auto plan = plan_of(diagram(servo, R"("stop": 1, "step": 0.0005)"));
  return analyse(*plan, request);
}

TEST(Analysis, TheLoopAtABreakPointIsControllerTimesPlant) {
  LinearizeRequest request;
  request.break_point = "mass.force";
  const LinearAnalysis analysis = analyse_servo(request);
  const double T = 0.002;
  for (size_t i = 0; i < analysis.loop->frequency.size(); i += 37) {
    const std::complex<double> z = std::exp(std::complex<double>(0, analysis.loop->frequency[i] * T));
    const std::complex<double> s = 2 / T * (z - 1.0) / (z + 1.0);  // Tustin's rule
    const std::complex<double> pd = 400.0 + 28.0 * 500.0 * s / (s + 500.0);
    const std::complex<double> plant = T * T / 2 * (z + 1.0) / ((z - 1.0) * (z - 1.0));
    const std::complex<double> wanted = pd / z * plant;
    EXPECT_NEAR(std::abs(analysis.loop->response[i] / wanted - 1.0), 0, 1e-8) << analysis.loop->frequency[i];
  }
  EXPECT_TRUE(analysis.loop->margins.is_stable());
}

TEST(Analysis, WhereTheLoopIsCutDoesNotMatterForItsMargins) {
  LinearizeRequest request;
  request.break_point = "mass.force";
  const Margins at_force = analyse_servo(request).loop->margins;
  request.break_point = "sensor.u";
  const Margins at_sensor = analyse_servo(request).loop->margins;
  EXPECT_NEAR(at_force.Ms, at_sensor.Ms, 1e-6);
  EXPECT_NEAR(at_force.phase, at_sensor.phase, 1e-9);
  EXPECT_NEAR(at_force.delay, at_sensor.delay, 1e-9);
}

/// Two loops share an integrator: L = 10/s + 50/s², and 10/s alone once the other one is cut.
TEST(Analysis, LoopsThatTheUserCutStayCutForTheMargins) {
  const auto plan = plan_of(diagram(R"(
  "outer": {"type": "Gain", "gain": 50, "in": {"u": "position.y"}},
  "inner": {"type": "Gain", "gain": 10, "in": {"u": "speed.y"}},
  "total": {"type": "Sum", "signs": "--", "in": {"terms": ["outer.y", "inner.y"]}},
  "speed": {"type": "Integrator", "in": {"u": "total.sum"}},
  "position": {"type": "Integrator", "in": {"u": "speed.y"}})",
                                    R"("stop": 1, "step": 0.0005)"));
  LinearizeRequest request;
  request.break_point = "speed.u";
  EXPECT_LT(analyse(*plan, request).loop->margins.phase, 1.3);
  request.access.open = {"position.u"};
  EXPECT_NEAR(analyse(*plan, request).loop->margins.phase, std::numbers::pi / 2, 1e-6);
  request.access.open = {"position.u", "speed.u"};
  EXPECT_NEAR(analyse(*plan, request).loop->margins.phase, std::numbers::pi / 2, 1e-6);
}

TEST(Analysis, ADelayPlacedInTheLoopUsesUpTheDelayMargin) {
  LinearizeRequest request;
  request.break_point = "mass.force";
  const double margin = analyse_servo(request).loop->margins.delay;
  const auto is_stable_with = [&](double delay) {
    std::string text = diagram(servo, R"("stop": 1, "step": 0.0005)");
    text.replace(text.find("\"force\": \"late.y\""), 17, "\"force\": \"line.y\"");
    text.replace(
        text.find("\"mass\": {"), 0,
        fmt::format(
            "\"line\": {{\"type\": \"TransportDelay\", \"delay\": {}, \"in\": {{\"u\": \"late.y\"}}}},\n",
            delay));
    const auto plan = plan_of(text);
    return is_stable(sampled_system(linearize_at_start(*plan), {}).matrices);
  };
  EXPECT_TRUE(is_stable_with(0.99 * margin));
  EXPECT_FALSE(is_stable_with(1.01 * margin));
}

TEST(Analysis, SimulatedSinesMeasureTheLinearResponse) {
  LinearizeRequest request;
  request.access = {{"mass.force"}, {"sensor.y"}, {}};
  const LinearAnalysis analysis = analyse_servo(request);
  DiagramFolder folder;
  Problems problems;
  const auto loaded = load_diagram(
      folder.with("top.json", diagram(servo, R"("stop": 1, "step": 0.0005)")).path("top.json"), {}, problems);
  SineTest test;
  test.from = "mass.force", test.to = "sensor.y";
  test.sample_time = 0.002, test.settle = 0.6, test.periods = 4;
  test.frequencies = {4 * pi, 20 * pi, 60 * pi, 200 * pi};
  const FrequencyResponse linear(analysis.system.matrices);
  for (const MeasuredPoint& point : measure_response(*loaded, test))
    EXPECT_NEAR(std::abs(point.response / linear.at(point.frequency)(0, 0) - 1.0), 0, 2e-3)
        << point.frequency;
}

/// What sines measure at the only frequency of the test, in rad/s.
std::complex<double> measured(const std::string& text, SineTest test, double frequency) {
  DiagramFolder folder;
  Problems problems;
  const auto loaded = load_diagram(folder.with("top.json", text).path("top.json"), {}, problems);
  test.sample_time = 0.01, test.holds = false, test.periods = 3;
  test.frequencies = {frequency};
  const MeasuredPoint point = measure_response(*loaded, test).at(0);
  EXPECT_NEAR(point.frequency, frequency, 0.05 * frequency);
  return point.response;
}

/// A speed loop: a mass of 1 kg with a drag of 1 N·s/m, gain 20, wanted 1 m/s. At rest, the force is 20 N.
const std::string speed_loop = diagram(R"(
  "wanted": {"type": "Constant", "value": {"value": 1, "unit": "m/s"}},
  "error": {"type": "Sum", "signs": "+-", "in": {"terms": ["wanted.y", "mass.velocity"]}},
  "gain": {"type": "Gain", "gain": {"value": 20, "unit": "N*s/m"}, "in": {"u": "error.sum"}},
  "net": {"type": "Sum", "signs": "+-", "in": {"terms": ["gain.y", "drag.force"]}},
  "mass": {"type": "Mass", "mass": {"value": 1, "unit": "kg"}, "in": {"force": "net.sum"}},
  "drag": {"type": "ViscousFriction", "damping": {"value": 1, "unit": "N*s/m"}, "in": {"velocity": "mass.velocity"}})",
                                       R"("stop": 1, "step": 0.001)");

TEST(Analysis, SinesMeasureALoopThatIsCut) {
  SineTest test;
  test.from = "net.terms[0]", test.to = "mass.velocity", test.settle = 12;
  const double w = 2 * pi;  // whole periods in rows
  EXPECT_NEAR(std::abs(measured(speed_loop, test, w) - 1.0 / std::complex<double>(21, w)), 0, 1e-6);
  test.open = {"net.terms[0]"};
  EXPECT_NEAR(std::abs(measured(speed_loop, test, w) - 1.0 / std::complex<double>(1, w)), 0, 1e-5);
  test.from = "mass.force", test.open = {"error.terms[1]"};
  EXPECT_NEAR(std::abs(measured(speed_loop, test, w) - 1.0 / std::complex<double>(1, w)), 0, 1e-5);
}

TEST(Analysis, SinesMeasureTheOperatingPointOfItsTime) {
  const std::string text = diagram(R"(
  "u": {"type": "Constant", "value": 0}, "k": {"type": "Step", "time": 1, "before": 1, "after": 11},
  "p": {"type": "Product", "in": {"factors": ["u.y", "k.y"]}},
  "lag": {"type": "StrictlyProperTransferFunction", "numerator": [1], "denominator": [0.1, 1], "in": {"u": "p.product"}})",
                                   R"("stop": 3, "step": 0.001)");
  SineTest test;
  test.from = "p.factors[0]", test.to = "lag.y", test.settle = 2;
  const double w = 4 * pi;
  test.at = 2;
  EXPECT_NEAR(std::abs(measured(text, test, w) - 11.0 / std::complex<double>(1, 0.1 * w)), 0, 1e-4);
}

/// v' = 2 (1 - v) - v²: at rest v = √3 - 1. Cut there, the slope of v² remains: 1/(s + 2 v).
TEST(Analysis, ACutHoldsWhatTheLoopReadAtTheOperatingPoint) {
  const std::string text = diagram(R"(
  "wanted": {"type": "Constant", "value": 1},
  "error": {"type": "Sum", "signs": "+-", "in": {"terms": ["wanted.y", "v.y"]}},
  "gain": {"type": "Gain", "gain": {"value": 2, "unit": "1/s"}, "in": {"u": "error.sum"}},
  "square": {"type": "Product", "in": {"factors": ["v.y", "v.y"]}},
  "rate": {"type": "Gain", "gain": {"value": 1, "unit": "1/s"}, "in": {"u": "square.product"}},
  "net": {"type": "Sum", "signs": "+-", "in": {"terms": ["gain.y", "rate.y"]}},
  "v": {"type": "Integrator", "in": {"u": "net.sum"}})",
                                   R"("stop": 1, "step": 0.001)");
  SineTest test;
  test.from = "net.terms[0]", test.to = "v.y", test.settle = 12, test.amplitude = 1e-4;
  test.open = {"net.terms[0]"}, test.at = 10;
  const double w = 2 * pi, rest = std::sqrt(3.0) - 1;
  EXPECT_NEAR(std::abs(measured(text, test, w) - 1.0 / std::complex<double>(2 * rest, w)), 0, 1e-5);
}

TEST(Analysis, SinesAreRefusedWhereTheyWouldDriveSomethingElse) {
  const auto refusal = [](const std::string& text, const std::string& from, const std::string& open) {
    SineTest test;
    test.from = from, test.to = "out.y";
    if (!open.empty()) test.open = {open};
    try {
      measured(text, test, 6);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const std::string text = diagram(R"(
  "a": {"type": "Constant", "value": [1, 2]},
  "sum": {"type": "Sum", "in": {"terms": ["a.y", "one.y"]}},
  "one": {"type": "Constant", "value": 0}, "out": {"type": "Gain", "gain": 1, "in": {"u": "one.y"}})");
  EXPECT_THAT(refusal(text, "sum.terms[1]", ""), HasSubstr("one number"));
  EXPECT_THAT(refusal(text, "out.u", "one.y"), HasSubstr("no cut can be simulated at"));
  EXPECT_EQ(refusal(text, "out.u", ""), "");
}

TEST(Analysis, AnInterruptionIsNoFailure) {
  const std::atomic<bool> interrupt = true;
  RunOptions options;
  options.interrupt = &interrupt;
  const auto plan = plan_of(speed_loop);
  EXPECT_THROW(linearize_at(*plan, 0.5, options), Interrupted);
  DiagramFolder folder;
  Problems problems;
  const auto loaded = load_diagram(folder.with("top.json", speed_loop).path("top.json"), {}, problems);
  SineTest test;
  test.from = "mass.force", test.to = "mass.velocity", test.frequencies = {10};
  EXPECT_THROW(measure_response(*loaded, test, options), Interrupted);
}

TEST(Analysis, WhatIsOutsideOfALoopIsSaid) {
  const auto plan = plan_of(speed_loop);
  LinearizeRequest request;
  request.break_point = "gain.u";
  const LinearAnalysis analysis = analyse(*plan, request);
  EXPECT_TRUE(analysis.loop->margins.is_stable()) << "the position is behind the speed loop";
  EXPECT_THAT(to_text(analysis), HasSubstr("closed it is stable"));
  EXPECT_THAT(to_text(analysis), HasSubstr("the mode at s = 0 (mass.position 100 %) does not decay"));
  EXPECT_EQ(nlohmann::json::parse(to_json(analysis))["loop"]["outside"].size(), 1u);
  EXPECT_NO_THROW(report::to_html(linear_page(analysis)));
  request.break_point = "wanted.y";
  EXPECT_THAT(to_text(analyse(*plan, request)), HasSubstr("in no loop"));
}

/// 1e4/(s (s + 1)) crosses 1 at 100 rad/s, far above its poles: the plots of the loop reach that far.
TEST(Analysis, PlotsOfALoopReachItsCrossover) {
  const auto plan = plan_of(diagram(R"(
  "gain": {"type": "Gain", "gain": -10000, "in": {"u": "x.y"}},
  "net": {"type": "Sum", "signs": "+-", "in": {"terms": ["gain.y", "v.y"]}},
  "v": {"type": "Integrator", "in": {"u": "net.sum"}},
  "x": {"type": "Integrator", "in": {"u": "v.y"}})",
                                    R"("stop": 1, "step": 0.0005)"));
  LinearizeRequest request;
  request.break_point = "gain.u";
  const LoopAnalysis loop = *analyse(*plan, request).loop;
  EXPECT_GT(loop.frequency.back(), 900);
  EXPECT_NEAR(loop.margins.phase * 180 / pi, 0.573, 1e-3);
}

TEST(Analysis, ASignalCannotBeAddedWhereThereIsNoWire) {
  DiagramFolder folder;
  Problems problems;
  const auto loaded = load_diagram(folder.with("top.json", diagram(servo)).path("top.json"), {}, problems);
  SineTest test;
  test.from = "mass.forse", test.to = "sensor.y";
  test.frequencies = {10};
  try {
    measure_response(*loaded, test);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_THAT(e.what(), HasSubstr("did you mean \"mass.force\""));
  }
}

TEST(Analysis, JsonHoldsWhatWasFound) {
  LinearizeRequest request;
  request.access = {{"mass.force"}, {"mass.position", "mass.velocity"}, {}};
  request.break_point = "mass.force";
  const LinearAnalysis analysis = analyse_servo(request);
  const auto json = nlohmann::json::parse(to_json(analysis));
  EXPECT_EQ(json["A"].size(), analysis.system.states.size());
  EXPECT_EQ(json["poles"].size(), analysis.system.states.size());
  EXPECT_EQ(json["response"]["channels"].size(), 2u);
  EXPECT_NEAR(json["loop"]["Ms"].get<double>(), analysis.loop->margins.Ms, 1e-12);
  EXPECT_EQ(to_recording(analysis).columns.size(), 5u);
  EXPECT_NO_THROW(report::to_html(linear_page(analysis)));
}

/// The distance of the curve from -1 is at least 1/Ms, and reaches it; far away there is a gap.
TEST(Analysis, TheNyquistCurveTouchesTheCircleOfMs) {
  LinearizeRequest request;
  request.access = {{"mass.force"}, {"mass.position"}, {}};
  request.break_point = "mass.force";
  const LinearAnalysis analysis = analyse_servo(request);
  const NyquistCurves curves = nyquist_curves(*analysis.loop);
  ASSERT_EQ(curves.real.size(), analysis.loop->response.size());
  double nearest = 1e300;
  size_t gaps = 0;
  for (size_t i = 0; i < curves.real.size(); ++i) {
    gaps += std::isnan(curves.real[i]);
    EXPECT_EQ(std::isnan(curves.real[i]), !(std::abs(analysis.loop->response[i]) < 5));
    if (!std::isnan(curves.real[i]))
      nearest = std::min(nearest, std::hypot(curves.real[i] + 1, curves.imaginary[i]));
  }
  EXPECT_GT(gaps, 0u) << "two integrators";
  for (size_t i = 0; i < curves.circle_real.size(); ++i)
    EXPECT_NEAR(std::hypot(curves.circle_real[i] + 1, curves.circle_imaginary[i]), nearest, 0.02 * nearest);
}

TEST(Analysis, ABreakPointOfSeveralNumbersIsRefused) {
  const auto plan = plan_of(diagram(R"(
    "a": {"type": "Constant", "value": 0},
    "sum": {"type": "Sum", "in": {"terms": ["a.y", "a.y"]}})"));
  LinearizeRequest request;
  request.break_point = "sum.terms";
  EXPECT_THROW(analyse(*plan, request), InputError);
  request.break_point = "sum.terms[1]";
  EXPECT_NO_THROW(analyse(*plan, request));
}

}  // namespace
}  // namespace loopwright::analysis_test
