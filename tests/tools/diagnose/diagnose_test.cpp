// Records with a missing force: is the effect named, with the correct parameter, and no other effect?
#include "tools/diagnose/diagnose.h"
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/recorded_axis.h"

namespace loopwright::diagnose_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Diagnosis diagnosis_of(const RecordedAxis& axis) { return diagnose(axis.diagram(), {axis.experiment()}); }

const DiagnosedParameter& parameter(const DiagnosedEffect& effect, std::string_view name) {
  return *std::ranges::find(effect.parameters, name, &DiagnosedParameter::name);
}

TEST(Diagnose, CoulombFrictionIsFoundWithItsLevelInsideTheInterval) {
  Truth truth;
  truth.force = [](double, double v, double) { return 0.12 * std::clamp(v / 1e-4, -1.0, 1.0); };
  const Diagnosis d = diagnosis_of(RecordedAxis(truth));
  EXPECT_EQ(d.verdict, Verdict::explained);
  ASSERT_THAT(names(d), ElementsAre("coulomb_friction"));
  const DiagnosedParameter& level = d.effects[0].parameters[0];
  EXPECT_EQ(level.name, "level");
  EXPECT_EQ(level.unit, "N");
  EXPECT_LT(level.low, 0.12);
  EXPECT_GT(level.high, 0.12);
  EXPECT_LT(level.high - level.low, 0.01);
  EXPECT_LT(d.error_after, 0.2 * d.error_before);
}

TEST(Diagnose, MoreMassThanTheDiagramSaysIsTold) {
  Truth truth;
  truth.mass = 0.3;
  const Diagnosis d = diagnosis_of(RecordedAxis(truth));
  ASSERT_THAT(names(d), ElementsAre("inertia"));
  EXPECT_NEAR(d.effects[0].parameters[0].value, 0.3 - 0.2621, 0.001);
}

TEST(Diagnose, CoggingIsFoundAtItsPitchInRadiansAndAmperes) {
  Truth truth;
  truth.position_unit = "rad", truth.force_unit = "A";
  truth.force = [](double x, double, double) { return 0.1 * std::sin(2 * std::numbers::pi * x / 0.0225); };
  const Diagnosis d = diagnosis_of(RecordedAxis(truth));
  ASSERT_THAT(names(d), ElementsAre("cogging"));
  EXPECT_EQ(parameter(d.effects[0], "pitch").unit, "rad");
  EXPECT_NEAR(parameter(d.effects[0], "pitch").value, 0.0225, 1e-5);
  EXPECT_NEAR(std::hypot(parameter(d.effects[0], "sine").value, parameter(d.effects[0], "cosine").value), 0.1,
              0.002);
  EXPECT_EQ(d.force_unit, "A");
}

TEST(Diagnose, AForceThatNoEffectExplainsGetsNoNameButItsVariable) {
  Truth truth;  // a bump in the middle of the stroke
  truth.force = [](double x, double, double) { return 0.3 * std::exp(-std::pow((x - 0.15) / 0.01, 2)); };
  const Diagnosis d = diagnosis_of(RecordedAxis(truth));
  EXPECT_THAT(d.verdict, testing::AnyOf(Verdict::unexplained, Verdict::partly_explained));
  EXPECT_THAT(d.remainder_variables, ElementsAre("position"));
}

TEST(Diagnose, JsonHasTheKeysThatOthersReadAndTheTextSaysTheSame) {
  Truth truth;
  truth.damping = 5;
  const RecordedAxis axis(truth);
  DiagnoseOptions options;
  options.improved_diagram = axis.file("improved.json");
  const Diagnosis d = diagnose(axis.diagram(), {axis.experiment()}, options);
  const auto json = nlohmann::json::parse(to_json(d));
  EXPECT_EQ(json["verdict"], "explained");
  EXPECT_EQ(json["effects"][0]["effect"], "viscous_friction");
  EXPECT_NEAR(json["effects"][0]["parameters"]["damping"]["value"], 2, 0.02);
  for (const char* key : {"value", "unit", "low", "high"})
    EXPECT_TRUE(json["effects"][0]["parameters"]["damping"].contains(key)) << key;
  EXPECT_GT(json["effects"][0]["inclusion"], 0.9);
  EXPECT_TRUE(json["effects"][0]["alternatives"].is_array());
  EXPECT_EQ(json["steps"][1]["added"][0], "viscous_friction");
  for (const char* key : {"force_rmse", "held_out_force_rmse", "simulation_rmse"})
    EXPECT_LT(json["steps"][1][key], json["steps"][0][key]) << key;
  EXPECT_LT(json["error"]["after"], json["error"]["before"]);
  EXPECT_EQ(json["error"]["unit"], "N");
  EXPECT_EQ(json["diagram"], axis.file("improved.json"));
  EXPECT_THAT(to_text(d), HasSubstr("viscous_friction"));
  Problems problems;
  EXPECT_TRUE(load_diagram(axis.file("improved.json"), {}, problems)) << problems.text();
}

TEST(Diagnose, FrictionThatWasAddedIsNotMissingAnyMoreNorInTheTableOfErrors) {
  Truth truth;
  truth.force = [](double, double v, double) { return 0.12 * std::clamp(v / 1e-4, -1.0, 1.0); };
  const RecordedAxis axis(truth);
  DiagnoseOptions options;
  options.improved_diagram = axis.file("improved.json");
  const Diagnosis before = diagnose(axis.diagram(), {axis.experiment()}, options);
  const Diagnosis after = diagnose(axis.file("improved.json"), {axis.experiment()});
  EXPECT_EQ(after.verdict, Verdict::nothing_missing) << to_text(after);
  EXPECT_NEAR(after.error_before, before.error_after, 0.1 * before.error_after);
}

TEST(Diagnose, NamesThePortWithWhichTheExperimentReachesAnEffectOfTheInput) {
  RecordedAxis axis(Truth{});
  axis.spoil([](std::vector<double>& force, std::vector<double>&) {
    for (double& f : force) f /= 0.8;  // the motor produces four fifths of the command
  });
  DiagnoseOptions options;
  options.improved_diagram = axis.file("improved.json");
  const Diagnosis before = diagnose(axis.diagram(), {axis.experiment()}, options);
  ASSERT_THAT(names(before), ElementsAre("force_gain")) << to_text(before);
  // The effect and the way around it when it is taken out both read the input: one port for both.
  ASSERT_EQ(before.experiment_ports.size(), 1u);
  EXPECT_EQ(before.experiment_ports[0].from, "motor.u");
  EXPECT_THAT(before.experiment_ports[0].to, ElementsAre("force_gain_input.u"));
  EXPECT_THAT(to_text(before), HasSubstr("must name force_gain_input.u in the place of motor.u"));
  const auto json = nlohmann::json::parse(to_json(before));
  EXPECT_EQ(json["experiment_ports"][0]["from"], "motor.u");
  EXPECT_EQ(json["experiment_ports"][0]["to"][0], "force_gain_input.u");

  std::ifstream in(axis.experiment());
  std::string text(std::istreambuf_iterator<char>(in), {});
  for (size_t at = 0; (at = text.find("\"motor.u\"")) != text.npos;)
    text.replace(at, 9, "\"force_gain_input.u\"");
  std::ofstream(axis.file("moved.experiment.json")) << text;
  const Diagnosis after = diagnose(axis.file("improved.json"), {axis.file("moved.experiment.json")});
  EXPECT_EQ(after.verdict, Verdict::nothing_missing) << to_text(after);
  EXPECT_NEAR(after.error_before, before.error_after, 0.1 * before.error_after);
}

TEST(Diagnose, WritesNothingWhenItIsInterrupted) {
  Truth truth;
  truth.damping = 5, truth.duration_s = 3;
  const RecordedAxis axis(truth);
  const std::atomic<bool> interrupt = true;
  DiagnoseOptions options;
  options.improved_diagram = axis.file("improved.json"), options.interrupt = &interrupt;
  EXPECT_TRUE(diagnose(axis.diagram(), {axis.experiment()}, options).was_interrupted);
  EXPECT_FALSE(std::filesystem::exists(options.improved_diagram));
}

}  // namespace
}  // namespace loopwright::diagnose_test
