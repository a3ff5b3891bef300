#include "tools/linearize/analysis.h"
#include <gmock/gmock.h>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
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
  EXPECT_TRUE(analysis.loop->margins.is_stable);
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
