// Numbers that differ by element, and parameters of the diagram inside formulas.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include "engine/run/run.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::block_settings_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

double last(const RunResult& result, std::string_view name) { return signal(result, name).back(); }

TEST(NumbersByElement, AConstantMayBeAVector) {
  const RunResult result =
      run_of(diagram(R"("c": {"type": "Constant", "value": [1, {"value": 20, "unit": "mm"}, "=3*2"]},
      "g": {"type": "Gain", "gain": 10, "in": {"u": "c.y"}}, "s": {"type": "Unpack", "index": 2, "in": {"u": "g.y"}})"));
  EXPECT_EQ(last(result, "c.y[1]"), 0.02);
  EXPECT_EQ(last(result, "g.y[0]"), 10);
  EXPECT_EQ(last(result, "g.y[2]"), 60);
  EXPECT_EQ(last(result, "s.y"), 60);
}

TEST(NumbersByElement, AreThoseOfSingleBlocks) {
  // Three axes with masses, dampings and start values of their own, as vectors and one by one.
  const RunResult result = run_of(diagram(
      R"("f": {"type": "Constant", "value": [1, -2, 3]},
         "axes": {"type": "Mass", "mass": [1, 2, 4], "initial_position": [0, 0.5, 1], "in": {"force": "f.y"}},
         "f2": {"type": "Constant", "value": 3},
         "third": {"type": "Mass", "mass": 4, "initial_position": 1, "in": {"force": "f2.y"}})",
      R"("stop": 1, "step": 0.01)"));
  const auto &wide = signal(result, "axes.position[2]"), &single = signal(result, "third.position");
  EXPECT_EQ(wide, single);
  EXPECT_NEAR(last(result, "axes.position[1]"), 0.5 - 0.5, 1e-12);
}

TEST(NumbersByElement, TakeTheParametersOfTheDiagram) {
  const RunResult result =
      run_of(diagram(R"("c": {"type": "Constant", "value": "=targets"})", R"("stop": 1, "step": 0.1)",
                     R"(, "parameters": {"targets": {"value": [1, 2, 3], "unit": "mm"}})"));
  EXPECT_EQ(last(result, "c.y[2]"), 0.003);
}

TEST(NumbersByElement, AreFoundByTheirPaths) {
  const auto plan = plan_of(diagram(R"("c": {"type": "Constant", "value": [5, 6]})"));
  loopwright::Run<double> run(*plan);
  ASSERT_NE(run.parameter("c[1].value"), nullptr);
  EXPECT_EQ(*run.parameter("c[1].value"), 6);
  EXPECT_EQ(last(run_of(diagram(R"("c": {"type": "Constant", "value": [5, 6]})"), {}), "c.y[1]"), 6);
  LoadOptions options;
  options.set = {{"c.value.1", "7"}};
  EXPECT_EQ(
      last(simulate(*plan_of(diagram(R"("c": {"type": "Constant", "value": [5, 6]})"), options)), "c.y[1]"),
      7);
}

TEST(NumbersByElement, CheckUnitsAndRangesOfEachElement) {
  EXPECT_THAT(
      problems_of(diagram(
          R"("c": {"type": "Constant", "value": [{"value": 1, "unit": "m"}, {"value": 1, "unit": "s"}]})")),
      HasSubstr("value"));
  const std::string range = problems_of(diagram(
      R"("f": {"type": "Constant", "value": 1}, "m": {"type": "Mass", "mass": [1, -2], "in": {"force": "f.y"}})"));
  EXPECT_THAT(range, HasSubstr("out of range"));
  EXPECT_THAT(range, HasSubstr("-2"));
}

TEST(Numbers, WithAUnitInOneTextAreToldHowTheyAreWritten) {
  const auto told = [](const char* mass) {
    return problems_of(diagram(fmt::format(R"("f": {{"type": "Constant", "value": 1}},
      "m": {{"type": "Mass", "mass": "{}", "in": {{"force": "f.y"}}}})",
                                           mass)));
  };
  EXPECT_THAT(told("1.2 kg"), HasSubstr(R"(written {"value": 1.2, "unit": "kg"})"));
  EXPECT_THAT(told("80g"), HasSubstr(R"(written {"value": 80, "unit": "g"})"));
  EXPECT_THAT(told("1.2"), HasSubstr("stands without quotes"));
  EXPECT_THAT(told("inf kg"), HasSubstr("stands without quotes"));
  EXPECT_THAT(told("3 apples"), HasSubstr("stands without quotes"));
}

TEST(NumbersByElement, MustBeAsManyAsTheElementsOfTheWires) {
  const std::string wires = problems_of(diagram(R"("c": {"type": "Constant", "value": [1, 2, 3]},
      "g": {"type": "Gain", "gain": [1, 2], "in": {"u": "c.y"}})"));
  EXPECT_THAT(wires, HasSubstr("\"gain\" has 2 elements, and the wires have 3"));
  const std::string two = problems_of(diagram(R"("c": {"type": "Constant", "value": 1},
      "m": {"type": "Mass", "mass": [1, 2], "initial_position": [1, 2, 3], "in": {"force": "c.y"}})"));
  EXPECT_THAT(two, HasSubstr("different numbers of elements"));
}

TEST(NumbersByElement, AreRefusedWhereTheUnitFollowsFromThem) {
  EXPECT_THAT(problems_of(diagram(R"("c": {"type": "Constant", "value": [1, 2]},
      "p": {"type": "Power", "exponent": [1, 2], "in": {"u": "c.y"}})")),
              HasSubstr("wrong kind of value"));
}

const char* const with_parameters =
    R"(, "parameters": {"length": {"value": 50, "unit": "cm"}, "g": {"value": 9.81, "unit": "m/s^2"},
    "n": 3, "name": "text"})";
const char* const short_run = R"("stop": 1, "step": 0.1)";

TEST(FormulaParameters, AreSeenByExpressions) {
  const std::string text = diagram(R"("x": {"type": "Constant", "value": {"value": 2, "unit": "m"}},
      "e": {"type": "Expression", "formula": "n * g * x / length", "names": ["x"], "in": {"arguments": ["x.y"]}})",
                                   short_run, with_parameters);
  const auto plan = plan_of(text);
  EXPECT_EQ(last(simulate(*plan), "e.y"), 3 * 9.81 * 2 / 0.5);
  EXPECT_EQ(to_string(plan->unit_of(plan->find("e.y")[0]).value()), "m/s^2");
}

TEST(FormulaParameters, FollowSetAndDifferBySubdiagram) {
  const std::string text = diagram(
      R"("a": {"diagram": {"loopwright": 1, "parameters": {"n": 5}, "blocks": {
            "x": {"type": "Constant", "value": 1},
            "e": {"type": "Expression", "formula": "n*x", "names": ["x"], "in": {"arguments": ["x.y"]}}}}},
         "b": {"diagram": {"loopwright": 1, "parameters": {"n": 5}, "blocks": {
            "x": {"type": "Constant", "value": 1},
            "e": {"type": "Expression", "formula": "n*x", "names": ["x"], "in": {"arguments": ["x.y"]}}}},
            "parameters": {"n": "=n+4"}})",
      short_run, with_parameters);
  const RunResult result = run_of(text);
  EXPECT_EQ(last(result, "a.e.y"), 5);
  EXPECT_EQ(last(result, "b.e.y"), 7);
  LoadOptions options;
  options.set = {{"a.n", "11"}};
  EXPECT_EQ(last(simulate(*plan_of(text, options)), "a.e.y"), 11);
}

TEST(FormulaParameters, AnArgumentHidesThem) {
  const RunResult result = run_of(diagram(R"("x": {"type": "Constant", "value": 2},
      "e": {"type": "Expression", "formula": "10*n", "names": ["n"], "in": {"arguments": ["x.y"]}})",
                                          short_run, with_parameters));
  EXPECT_EQ(last(result, "e.y"), 20);
}

TEST(FormulaParameters, AreCheckedForUnits) {
  const std::string text =
      problems_of(diagram(R"("x": {"type": "Constant", "value": {"value": 2, "unit": "s"}},
      "e": {"type": "Expression", "formula": "x + length", "names": ["x"], "in": {"arguments": ["x.y"]}})",
                          short_run, with_parameters));
  EXPECT_THAT(text, HasSubstr("the formula mixes units"));
  EXPECT_THAT(text, HasSubstr("length in m"));
}

TEST(FormulaParameters, MustBeNumbers) {
  const std::string text = problems_of(diagram(R"("x": {"type": "Constant", "value": 2},
      "e": {"type": "Expression", "formula": "x + name", "names": ["x"], "in": {"arguments": ["x.y"]}})",
                                               short_run, with_parameters));
  EXPECT_THAT(text, HasSubstr("name"));
  EXPECT_THAT(text, HasSubstr("the formula cannot be read"));
}

TEST(FormulaParameters, AreTunableInAPlan) {
  const auto plan = plan_of(diagram(R"("x": {"type": "Constant", "value": 2},
      "e": {"type": "Expression", "formula": "n*x", "names": ["x"], "in": {"arguments": ["x.y"]}})",
                                    short_run, with_parameters));
  loopwright::Run<double> run(*plan);
  double* const n = run.parameter("e.constants.0.value");
  ASSERT_NE(n, nullptr);
  *n = 100;
  run.reset({});
  run.evaluate(run.due(), true);
  EXPECT_EQ(run.number(plan->find("e.y")[0]), 200);
}

}  // namespace
}  // namespace loopwright::block_settings_test
