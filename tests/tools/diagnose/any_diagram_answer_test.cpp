// Which path a diagnosis takes, and how the answer about any diagram is written.
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include "tests/judgement.h"
#include "tests/tools/diagnose/diagnosed.h"
#include "tests/tools/diagnose/plants.h"
#include "tests/tools/diagnose/recorded_axis.h"

namespace loopwright::any_diagram_answer_test {
namespace {

using testing::ContainsRegex, testing::HasSubstr, testing::Not;

std::string text_of(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}
/// A copy of the experiment without its roles, beside it.
std::string without_roles(const RecordedAxis& axis) {
  auto json = nlohmann::json::parse(text_of(axis.experiment()));
  json.erase("roles");
  const std::string file = axis.file("no_roles.experiment.json");
  std::ofstream(file) << json.dump();
  return file;
}
std::string refusal(const std::string& diagram, const std::vector<std::string>& experiments) {
  try {
    diagnose(diagram, experiments);
  } catch (const InputError& error) {
    return error.problems.text();
  }
  return "";
}
Truth axis_with_friction() {
  Truth truth;
  truth.force = [](double, double v, double) { return 0.8 * std::tanh(v / 1e-3); };
  truth.duration_s = 4;
  return truth;
}

TEST(AnyDiagramAnswer, RolesDecideWhichPathADiagnosisTakes) {
  IS_A_JUDGEMENT();
  const RecordedAxis axis(axis_with_friction());
  const Diagnosis of_axis = diagnose(axis.diagram(), {axis.experiment()});
  EXPECT_TRUE(of_axis.has_roles);
  EXPECT_EQ(names(of_axis), std::vector<std::string>{"coulomb_friction"}) << to_text(of_axis);
  const Diagnosis of_any = diagnose(axis.diagram(), {without_roles(axis)});
  EXPECT_FALSE(of_any.has_roles);
  ASSERT_EQ(names(of_any), std::vector<std::string>{"sign"}) << to_text(of_any);
  EXPECT_EQ(of_any.effects[0].site, "net_force.sum");
  expect_parameter(of_any.effects[0], "level", -0.8, 0.1, "N");
}
TEST(AnyDiagramAnswer, SeveralRecordsNeedRolesInEachOfThemOrInNone) {
  const RecordedAxis axis(axis_with_friction());
  const std::string other = without_roles(axis);
  EXPECT_THAT(refusal(axis.diagram(), {axis.experiment(), other}),
              HasSubstr("1 of 2 experiments name roles"));
  EXPECT_THAT(refusal(axis.diagram(), {other, other}), HasSubstr("this record is used already"));
}

Diagnosis of_overflowing_tanks() {
  Tanks m;
  m.lost = [](double level, double) { return 0.02 * std::max(0.0, level - 0.5); };
  m.second_outlet = 0.0055;
  const RecordedPlant files(tanks(m, 3));
  return diagnose(files.diagram(), {files.experiment()});
}

TEST(AnyDiagramAnswer, JsonTextAndPageNameSiteVariableAndMovedParameter) {
  const Diagnosis d = of_overflowing_tanks();
  const auto json = nlohmann::json::parse(to_json(d));
  EXPECT_EQ(json["verdict"], "explained") << to_text(d);
  ASSERT_EQ(json["effects"].size(), 1u) << to_text(d);
  EXPECT_EQ(json["effects"][0]["effect"], "overflow");
  EXPECT_EQ(json["effects"][0]["site"], "balance1.sum");
  EXPECT_EQ(json["effects"][0]["variables"], nlohmann::json({"level1.y"}));
  EXPECT_GT(json["effects"][0]["force_rms"], 0);
  const auto& moved = json["moved_parameters"]["second_outlet"];
  EXPECT_EQ(moved["stated"], 0.005);
  EXPECT_NEAR(moved["value"], 0.0055, 1e-4);
  EXPECT_LT(moved["low"], 0.0055);
  EXPECT_GT(moved["high"], 0.0055);
  EXPECT_TRUE(json["not_observable"].is_array());
  EXPECT_LT(json["steps"].back()["simulation_rmse"], json["steps"].front()["simulation_rmse"]);

  const std::string text = to_text(d);
  EXPECT_THAT(text, HasSubstr("overflow of level1.y at balance1.sum"));
  EXPECT_THAT(text, HasSubstr("second_outlet = 0.0055"));
  const std::string page = report::to_html(diagnosis_page(d));
  for (const char* part : {"What does the diagram lack?", "balance1.sum", "level1.y", "second_outlet",
                           "The staircase of the error"})
    EXPECT_THAT(page, HasSubstr(part));
  EXPECT_THAT(page, Not(ContainsRegex("[ >(]NaN")));  // numbers of plots are encoded, and may spell it
}
TEST(AnyDiagramAnswer, AnAxisKeepsItsKeys) {
  const RecordedAxis axis(axis_with_friction());
  const auto json = nlohmann::json::parse(to_json(diagnose(axis.diagram(), {axis.experiment()})));
  EXPECT_FALSE(json.contains("moved_parameters"));
  EXPECT_FALSE(json["effects"][0].contains("site"));
}

}  // namespace
}  // namespace loopwright::any_diagram_answer_test
