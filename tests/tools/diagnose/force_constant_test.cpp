// The path from the recorded input to the sum of forces belongs to the diagram: the same machine, driven by
// newtons, amperes, volts or milliamperes, lacks the same force.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include "engine/record/recording_file.h"
#include "tests/engine/written_diagram.h"
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/hidden_axis.h"
#include "tools/compare/compare.h"

namespace loopwright::force_constant_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A path from an input to newtons.
struct Drive {
  std::string name, input_unit;
  double newtons_per_input;
  std::string blocks;  ///< from "held.y" to "f.y"
  std::string force = "f.y", input_port = "f.u";
};

/// 2 kg on viscous friction, pushed by a held multisine of 16 N rms. The record contains 3 N*s/m that the
/// diagram lacks.
class DrivenMass {
 public:
  explicit DrivenMass(const Drive& drive) : drive_(drive) {
    folder_.with("truth.json", text(4)).with("nominal.json", text(1));
    const RunResult truth = simulate(*load_plan(folder_.path("truth.json")));
    write_recording(folder_.path("record.csv"), truth.recording);
    folder_.with("e.json", fmt::format(R"({{"loopwright": 1, "data": "record.csv",
      "drive": {{"{}": {{"column": "held.y"}}}},
      "compare": {{"mass.position": {{"column": "encoder.position", "resolution": 1e-6}}}},
      "roles": {{"position": "mass.position", "velocity": "mass.velocity", "force": "net.sum", "input": "{}"}}}})",
                                       drive.input_port, drive.input_port));
  }
  Comparison compared() const { return compare(folder_.path("nominal.json"), folder_.path("e.json")); }
  Diagnosis diagnosed() const { return diagnose(folder_.path("nominal.json"), {folder_.path("e.json")}); }

 private:
  std::string text(double damping) const {
    const auto amplitude = [&](double newtons) {
      return fmt::format(R"({{"value": {}, "unit": "{}"}})", newtons / drive_.newtons_per_input,
                         drive_.input_unit);
    };
    return diagram(
        fmt::format(
            R"("wanted": {{"type": "Multisine", "components": [{{"amplitude": {}, "frequency": 1}}, {{"amplitude": {}, "frequency": 3.3}}]}},
      "held": {{"type": "ZeroOrderHold", "sample_time": 0.001, "in": {{"u": "wanted.y"}}}},
      {},
      "viscous": {{"type": "ViscousFriction", "damping": {{"value": {}, "unit": "N*s/m"}}, "in": {{"velocity": "mass.velocity"}}}},
      "net": {{"type": "Sum", "signs": "+-", "in": {{"terms": ["{}", "viscous.force"]}}}},
      "mass": {{"type": "Mass", "mass": {{"value": 2, "unit": "kg"}}, "in": {{"force": "net.sum"}}}},
      "encoder": {{"type": "Encoder", "resolution": {{"value": 1, "unit": "um"}}, "in": {{"position": "mass.position"}}}})",
            amplitude(20), amplitude(10), drive_.blocks, damping, drive_.force),
        R"("method": "rk4", "step": 0.001, "stop": 20)",
        R"(, "log": ["held.y", "encoder.position", "mass.velocity", "viscous.force"])");
  }

  Drive drive_;
  DiagramFolder folder_;
};

Drive newtons() {
  return {"newtons", "N", 1,
          R"("f": {"type": "Gain", "gain": {"value": 1, "unit": "1"}, "in": {"u": "held.y"}})"};
}
std::vector<Drive> drives() {
  return {
      newtons(),
      {"amperes", "A", 20,
       R"("f": {"type": "Gain", "gain": {"value": 20, "unit": "N/A"}, "in": {"u": "held.y"}})"},
      {"milliamperes", "mA", 0.02,
       R"("f": {"type": "Gain", "gain": {"value": 20, "unit": "N/A"}, "in": {"u": "held.y"}})"},
      {"reversed volts", "V", -0.4,
       R"("f": {"type": "Gain", "gain": {"value": -0.4, "unit": "N/V"}, "in": {"u": "held.y"}})"},
      {"product", "A", 20,
       R"("k": {"type": "Constant", "value": {"value": 20, "unit": "N/A"}},
          "i": {"type": "Gain", "gain": {"value": 1, "unit": "1"}, "in": {"u": "held.y"}},
          "f": {"type": "Product", "in": {"factors": ["i.y", "k.y"]}})",
       "f.product", "i.u"},
      {"lag", "A", 20,
       R"("f": {"type": "Gain", "gain": {"value": 20, "unit": "N/A"}, "in": {"u": "held.y"}},
          "lag": {"type": "TransferFunction", "numerator": [1], "denominator": [0.002, 1], "in": {"u": "f.y"}})",
       "lag.y"},
      {"amplifier and motor", "V", 1.2,
       R"("drive": {"diagram": {"inputs": {"command": "V"}, "outputs": {"force": "motor.y"}, "blocks": {
            "amplifier": {"type": "Gain", "gain": {"value": 0.6, "unit": "A/V"}, "in": {"u": "command"}},
            "motor": {"type": "Gain", "gain": {"value": 2, "unit": "N/A"}, "in": {"u": "amplifier.y"}}}},
          "in": {"command": "f.y"}},
          "f": {"type": "Gain", "gain": {"value": 1, "unit": "1"}, "in": {"u": "held.y"}})",
       "drive.force"},
      {"sampled filter", "A", 20,
       R"("f": {"type": "Gain", "gain": {"value": 20, "unit": "N/A"}, "in": {"u": "held.y"}},
          "filter": {"type": "DiscreteTransferFunction", "sample_time": 0.001, "numerator": [0.5], "denominator": [1, -0.5], "in": {"u": "f.y"}})",
       "filter.y"},
  };
}

TEST(ForceConstant, CompareNamesTheSameForceWhateverTheInput) {
  for (const Drive& drive : drives()) {
    SCOPED_TRACE(drive.name);
    Drive exact = drive;  // without friction in the diagram all of 4 N*s/m is missing
    const Comparison c = DrivenMass(exact).compared();
    ASSERT_TRUE(c.force) << c.why_no_force;
    const ForceAnalysis& f = *c.force;
    EXPECT_EQ(f.motion.force_unit, "N");
    EXPECT_NEAR(f.mass, 2, 2e-3);
    EXPECT_NEAR(f.residual.rmse, 3.39, 0.05);
    EXPECT_NEAR(f.residual.relative_percent, 21.5, 0.6) << "of 15.8 N";
    EXPECT_NEAR(f.content.sizes.force_level, 15.81, 0.1);
    EXPECT_NEAR(f.content.sizes.machine_damping, 1, 0.3);
    EXPECT_TRUE(f.faults.empty()) << f.faults.front().text;
    EXPECT_THAT(to_text(c), HasSubstr("% of the force"));
  }
}

TEST(ForceConstant, DiagnoseNamesTheSameFrictionWhateverTheInput) {
  for (const Drive& drive : drives()) {
    SCOPED_TRACE(drive.name);
    const Diagnosis d = DrivenMass(drive).diagnosed();
    EXPECT_EQ(name_of(d.verdict), "explained");
    ASSERT_THAT(names(d), ElementsAre("viscous_friction"));
    EXPECT_EQ(d.force_unit, "N");
    EXPECT_NEAR(d.effects[0].parameters[0].value, 3, 0.01);
    EXPECT_EQ(d.effects[0].parameters[0].unit, "N*s/m");
    EXPECT_NEAR(d.error_before, 3.39, 0.05);
    EXPECT_LT(d.error_after, 0.04);
    EXPECT_THAT(to_text(d), testing::Not(HasSubstr("held out")));
    EXPECT_THAT(to_json(d), testing::Not(HasSubstr("held_out")));
  }
}

// ---- The generator's plants, with input and gain in other units ----

struct InputUnit {
  std::string column, diagram;
  double newtons_per_unit;  ///< of the column
  std::string gain;         ///< with its unit
};
const std::vector<InputUnit> input_units = {{"N", "N", 1, R"({"value": 1, "unit": "1"})"},
                                            {"A", "A", 12.5, R"({"value": 12.5, "unit": "N/A"})"},
                                            {"V", "V", 0.32, R"({"value": 0.32, "unit": "N/V"})"},
                                            {"mA", "A", 0.0125, R"({"value": 12.5, "unit": "N/A"})"}};

struct Answer {
  Diagnosis diagnosis;
  Comparison comparison;
};
Answer answer_in(const InputUnit& unit, const std::function<void(Physics&)>& hide) {
  HiddenMachine machine;
  machine.input_unit = unit.diagram, machine.column_unit = unit.column;
  machine.newtons_per_column = unit.newtons_per_unit, machine.gain = unit.gain;
  HiddenAxis axis(machine);
  Physics truth = axis.nominal();
  hide(truth);
  const std::string record = axis.record("record", truth, there_and_back(0.2, 0.4));
  return {diagnose(axis.diagram(), {record}), compare(axis.diagram(), record)};
}

/// Rounded to four digits.
constexpr double four_digits = 1e-4;
void expect_near(double value, double other, const char* what) {
  EXPECT_NEAR(value, other, four_digits * std::max(std::abs(value), std::abs(other))) << what;
}

void expect_same(const Answer& one, const Answer& other, double other_newtons_per_input) {
  const Diagnosis &d = one.diagnosis, &e = other.diagnosis;
  EXPECT_EQ(name_of(d.verdict), name_of(e.verdict));
  EXPECT_EQ(names(d), names(e));
  EXPECT_EQ(d.force_unit, "N");
  EXPECT_EQ(e.force_unit, "N");
  expect_near(d.error_before, e.error_before, "before");
  expect_near(d.error_after, e.error_after, "after");
  constexpr double noise_fit = 0.005;  // the search for the noise ends where the likelihood is flat
  EXPECT_NEAR(d.white_force, e.white_force, noise_fit * d.white_force);
  ASSERT_EQ(d.effects.size(), e.effects.size());
  for (size_t i = 0; i < d.effects.size(); ++i) {
    const DiagnosedEffect &a = d.effects[i], &b = e.effects[i];
    expect_near(a.force_rms, b.force_rms, a.name.c_str());
    EXPECT_EQ(a.alternatives, b.alternatives);
    for (size_t p = 0; p < a.parameters.size(); ++p) {
      const bool is_per_input = a.name == "force_saturation";
      const double scale = is_per_input ? other_newtons_per_input : 1;
      const DiagnosedParameter &x = a.parameters[p], &y = b.parameters[p];
      EXPECT_NEAR(x.value, y.value / scale,
                  std::max(four_digits * std::abs(x.value), 0.01 * (x.high - x.low)))
          << a.name << "." << x.name;
      if (!is_per_input) {
        EXPECT_EQ(x.unit, y.unit);
      }
    }
  }
  const ForceAnalysis &f = *one.comparison.force, &g = *other.comparison.force;
  EXPECT_EQ(f.motion.force_unit, g.motion.force_unit);
  expect_near(f.residual.rmse, g.residual.rmse, "missing force");
  expect_near(f.residual.relative_percent, g.residual.relative_percent, "relative");
  expect_near(f.residual.noise_floor, g.residual.noise_floor, "noise floor");
  expect_near(f.content.sizes.force_level, g.content.sizes.force_level, "force level");
  ASSERT_EQ(f.faults.size(), g.faults.size());
  for (size_t i = 0; i < f.faults.size(); ++i) EXPECT_EQ(f.faults[i].name, g.faults[i].name);
}

class InputUnits : public testing::TestWithParam<std::pair<const char*, std::function<void(Physics&)>>> {};
TEST_P(InputUnits, ChangeNothingButTheUnitOfTheInput) {
  const auto& hide = GetParam().second;
  const Answer newtons = answer_in(input_units.front(), hide);
  ASSERT_TRUE(newtons.comparison.force) << newtons.comparison.why_no_force;
  EXPECT_FALSE(newtons.diagnosis.effects.empty());
  for (const InputUnit& unit : input_units) {
    SCOPED_TRACE(unit.column);
    if (unit.column == "N") continue;
    const double si = unit.column == "mA" ? 1e3 * unit.newtons_per_unit : unit.newtons_per_unit;
    expect_same(newtons, answer_in(unit, hide), si);
  }
}
INSTANTIATE_TEST_SUITE_P(
    Generated, InputUnits,
    testing::Values(std::pair("friction",
                              [](Physics& p) { p.coulomb_n = 0.3, p.added_damping_n_s_per_m = 2; }),
                    std::pair("delay", [](Physics& p) { p.delay_s = 3e-3; }),
                    std::pair("saturation", [](Physics& p) { p.saturation_per_n = 0.05, p.offset_n = 0.2; })),
    [](const auto& one) { return std::string(one.param.first); });

}  // namespace
}  // namespace loopwright::force_constant_test
