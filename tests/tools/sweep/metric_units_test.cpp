// Units of metrics, of their limits, and of the values of axes.
#include <cmath>
#include <numbers>
#include "tests/engine/written_diagram.h"
#include "tests/tools/sweep/sweep_testing.h"

namespace loopwright::metric_units_test {
namespace {

const std::string loop = diagram(R"("a": {"type": "Constant", "value": {"value": 1, "unit": "mm"}},
"b": {"type": "Constant", "value": {"value": 1, "unit": "mm"}},
"w": {"type": "Constant", "value": {"value": 6, "unit": "rad/s"}},
"f": {"type": "Constant", "value": {"value": 2, "unit": "Hz"}},
"n": {"type": "Constant", "value": 7})");

SweepFolder sweep_of(const std::string& metric,
                     const std::string& axis = R"({"values": [2, 3], "unit": "mm"})") {
  return SweepFolder("\"a.value\": " + axis, "", "\"m\": {" + metric + "}", loop);
}

/// The metric of both runs.
std::vector<double> results_of(const std::string& metric) {
  const SweepFolder folder = sweep_of(metric);
  const SweepPlan plan = folder.plan();
  run_sweep(plan, folder.results(), {});
  return read_results(plan, folder.results()).table.find("m")->values;
}

TEST(MetricUnits, OfAnExpressionAreConverted) {
  using std::numbers::pi;
  const std::vector<std::pair<std::string, double>> cases = {
      {R"("final": "=a.y - b.y", "unit": "mm")", 2},
      {R"("final": "=a.y - b.y", "unit": "um")", 2000},
      {R"("final": "=sqrt(a.y*b.y)^2", "unit": "mm^2")", 3},
      {R"json("final": "=w.y/(2*pi)", "unit": "Hz")json", 6 / (2 * pi)},
      {R"json("final": "=w.y/(2*pi)", "unit": "rad/s")json", 6},
      {R"("final": "=2*pi*f.y", "unit": "rad/s")", 4 * pi},
      {R"("final": "=3*f.y", "unit": "rad/s")", 12 * pi},
      {R"("final": "=2*pi*f.y", "unit": "rpm")", 120},
      {R"("final": "=cos(pi)*n.y")", -7},
      {R"json("final": "=n.y*ln(e)")json", 7}};
  for (const auto& [metric, expected] : cases)
    EXPECT_NEAR(results_of(metric)[1] / expected, 1, 1e-14) << metric;
}

TEST(MetricUnits, OfAnExpressionAppearInTheTable) {
  const SweepFolder folder = sweep_of(R"("final": "=a.y*b.y")");
  EXPECT_EQ(folder.plan().world(0).observed.units[0], "m^2");
}

TEST(MetricUnits, OfAnExpressionAreChecked) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {R"("final": "=a.y - w.y")", "the expression mixes units"},
      {R"("final": "=w.y + f.y")", "the expression adds Hz and rad/s"},
      {R"("final": "=2*pi/f.y")", "2*pi over a frequency in Hz"},
      {R"("final": "=a.y - b.y", "unit": "N")", "the metric has another unit"},
      {R"("final": "=2*w.y", "unit": "1/min")", "the metric has another unit"},
      {R"("final": "w.y", "unit": "1/min")", "the metric has another unit"},
      {R"("settling_time": "=a.y + w.y", "target": 0, "band": 1)", "the expression mixes units"}};
  for (const auto& [metric, problem] : cases) {
    const std::string text = sweep_of(metric).problems();
    EXPECT_TRUE(has(text, problem)) << metric << "\n" << text;
    EXPECT_TRUE(has(text, "sweep.json:1:")) << text;
  }
  EXPECT_EQ(sweep_of(R"("final": "=a.y + n.y")").problems(), "") << "the unit of n is unknown";
}

Metric metric_of(const std::string& text) {
  const SweepFolder folder = sweep_of(text);
  EXPECT_EQ(folder.problems(), "") << text;
  Problems problems;
  return load_sweep(folder.folder.path("sweep.json"), problems)->metrics.at(0);
}

TEST(MetricUnits, OfLimitsAreConverted) {
  EXPECT_DOUBLE_EQ(metric_of(R"("final": "a.y", "unit": "um", "most": "0.8 mm")").most, 800);
  EXPECT_DOUBLE_EQ(metric_of(R"("final": "a.y", "unit": "um", "least": {"value": -1, "unit": "cm"})").least,
                   -1e4);
  EXPECT_DOUBLE_EQ(metric_of(R"("final": "a.y", "unit": "um", "most": 800)").most, 800);
  EXPECT_DOUBLE_EQ(metric_of(R"("final": "a.y", "most": "0.8 mm")").most, 8e-4);
  EXPECT_NEAR(metric_of(R"("final": "w.y", "unit": "rad/s", "most": "1 Hz")").most, 2 * std::numbers::pi,
              1e-15);
  const Metric settling = metric_of(
      R"("settling_time": "a.y", "target": "3 mm", "band": "5 um", "from": "20 ms", "most": "1 min")");
  EXPECT_DOUBLE_EQ(settling.target, 3e-3);
  EXPECT_DOUBLE_EQ(settling.band, 5e-6);
  EXPECT_DOUBLE_EQ(settling.from, 0.02);
  EXPECT_DOUBLE_EQ(settling.most, 60);
  EXPECT_DOUBLE_EQ(metric_of(R"("first_violation": "w.y", "threshold": "60 rpm")").threshold,
                   2 * std::numbers::pi);
}

TEST(MetricUnits, OfLimitsAreChecked) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {R"("final": "a.y", "unit": "um", "most": "5 N")", "\"most\" has another unit"},
      {R"("final": "a.y", "most": "5 N")", "\"most\" has another unit than the metric"},
      {R"("first_violation": "a.y", "threshold": {"value": 5, "unit": "s"})", "another unit than the signal"},
      {R"("first_violation": "w.y", "threshold": "60 1/min")", "another unit than the signal"},
      {R"("first_violation": "w.y", "threshold": "1 Hz")", "another unit than the signal"},
      {R"("overshoot": "=a.y - b.y", "target": "1 V")", "another unit than the signal"},
      {R"("settling_time": "a.y", "target": 0, "band": "-1 mm")", "\"band\" is out of range"},
      {R"("final": "a.y", "from": "1 m")", "\"from\" has another unit"},
      {R"("final": "w.y", "unit": "rad/s", "most": "60 1/min")", "can mean two numbers"}};
  for (const auto& [metric, problem] : cases)
    EXPECT_TRUE(has(sweep_of(metric).problems(), problem)) << metric << "\n" << sweep_of(metric).problems();
}

std::vector<double> values_of(const std::string& axis) {
  const SweepFolder folder = sweep_of(R"("final": "a.y")", axis);
  EXPECT_EQ(folder.problems(), "") << axis;
  const SweepPlan plan = folder.plan();
  std::vector<double> values;
  for (int64_t run = 0; run < plan.runs(); ++run) {
    const std::string text = plan.options(run).set.back().second;
    values.push_back(plan.design().point(run)[0]);
    EXPECT_TRUE(text.ends_with(plan.sweep().axes[0].unit)) << text;
  }
  return values;
}

TEST(AxisUnits, MayStandAtEachValue) {
  EXPECT_EQ(values_of(R"({"values": [2, 3], "unit": "mm"})"), (std::vector<double>{2, 3}));
  EXPECT_EQ(values_of(R"({"values": ["2 mm", {"value": 3, "unit": "mm"}]})"), (std::vector<double>{2, 3}));
  const auto mixed = values_of(R"({"values": ["2 mm", "0.5 cm"]})");
  EXPECT_DOUBLE_EQ(mixed[1], 5);
  const auto linear = values_of(R"({"linear": {"from": "1 mm", "to": 2000, "count": 2}, "unit": "um"})");
  EXPECT_DOUBLE_EQ(linear[0], 1000);
  EXPECT_EQ(linear[1], 2000);
}

TEST(AxisUnits, AreChecked) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {R"({"values": ["2 N"], "unit": "mm"})", "a value has another unit"},
      {R"({"values": ["2 mm", 3]})", "a value has no unit, unlike other numbers of the axis"},
      {R"({"linear": {"from": 1, "to": "2 mm", "count": 2}})", "\"from\" has no unit"},
      {R"({"values": ["many"]})", "expected: a number, \"5 um\""}};
  for (const auto& [axis, problem] : cases) {
    const std::string text = sweep_of(R"("final": "a.y")", axis).problems();
    EXPECT_TRUE(has(text, problem)) << axis << "\n" << text;
  }
}

}  // namespace
}  // namespace loopwright::metric_units_test
