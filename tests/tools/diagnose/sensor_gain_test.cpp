// Counts behind a Gain of the diagram are recorded in place of the position.
#include <gmock/gmock.h>
#include <fstream>
#include <sstream>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"

namespace loopwright::sensor_gain_test {
namespace {

constexpr double counts_per_metre = 5e6;

std::string text_of(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}

HiddenMachine with_counter() {
  HiddenMachine machine;
  machine.further_blocks =
      R"("counter": {"type": "Gain", "gain": {"value": 5e6, "unit": "1/m"}, "in": {"u": "mass.position"}},)";
  return machine;
}

/// The same record in counts of 0.2 µm; its experiment compares "counter.y".
std::string in_counts(HiddenAxis& axis, const Physics& truth, const std::string& position_role) {
  const std::string path = axis.record("record", truth, there_and_back(0.2, 0.4));
  std::istringstream metres(text_of(axis.file("record.csv")));
  std::ofstream counts(axis.file("record.csv"));
  std::string line;
  std::getline(metres, line);
  counts << line << "\n";
  while (std::getline(metres, line)) {
    double t = 0, force = 0, position = 0;
    EXPECT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", &t, &force, &position), 3);
    counts << fmt::format("{:.3f},{:.10g},{:.0f},0\n", t, force, counts_per_metre * position);
  }
  std::ofstream(path) << fmt::format(
      R"({{"loopwright": 1, "data": "record.csv", "time": "t_s",
  "drive": {{"motor.u": {{"column": "force", "unit": "N"}}}},
  "compare": {{"counter.y": {{"column": "position", "unit": "1", "resolution": 1}}}},
  "roles": {{"position": "{}", "velocity": "mass.velocity", "force": "net_force.sum", "input": "motor.u"}}}})",
      position_role);
  return path;
}

class SensorGain : public testing::TestWithParam<const char*> {};

TEST_P(SensorGain, IsTakenOutOfTheRecord) {
  HiddenAxis axis(with_counter());
  Physics truth = axis.nominal();
  truth.offset_n = 0.1, truth.cogging = {0.1, 0.024, 0.3};
  DiagnoseOptions options;
  options.improved_diagram = axis.file("improved.json"), options.writes_all = true;
  const std::string experiment = in_counts(axis, truth, GetParam());
  const Diagnosis d = diagnose(axis.diagram(), {experiment}, options);
  EXPECT_EQ(d.verdict, Verdict::explained) << to_text(d);
  ASSERT_THAT(names(d), testing::UnorderedElementsAre("constant_force", "cogging")) << to_text(d);
  EXPECT_EQ(d.position_unit, "m");
  const auto cogging = std::ranges::find(d.effects, "cogging", &DiagnosedEffect::name);
  expect_parameter(*cogging, "pitch", 0.024, 1e-4, "m");
  const Diagnosis after = diagnose(d.improved, {experiment});
  EXPECT_EQ(after.verdict, Verdict::nothing_missing) << to_text(after);
}

INSTANTIATE_TEST_SUITE_P(WithTheRole, SensorGain, testing::Values("mass.position", "counter.y"));

}  // namespace
}  // namespace loopwright::sensor_gain_test
