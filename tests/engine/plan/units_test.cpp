// Units are worked out along the wires; where they clash both ends are named.
#include <gtest/gtest.h>
#include "tests/engine/written_diagram.h"

namespace loopwright {
namespace {

std::string unit_of(const Plan& plan, std::string_view port) {
  const auto numbers = plan.find(port);
  if (numbers.size() != 1) throw std::invalid_argument("no port " + std::string(port));
  const auto unit = plan.unit_of(numbers[0]);
  return unit ? to_string(*unit) : "?";
}

/// A force on a mass with a position controller: units are written at the mass and the reference only.
constexpr std::string_view servo =
    R"("reference": {"type": "Sine", "amplitude": {"value": 5, "unit": "mm"}, "frequency": 1},
"error": {"type": "Sum", "signs": "+-", "in": {"terms": ["reference.y", "stage.position"]}},
"gain": {"type": "Gain", "gain": {"value": 100, "unit": "N/m"}, "in": {"u": "error.sum"}},
"stage": {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "in": {"force": "gain.y"}},
"speed": {"type": "Derivative", "cutoff": 100, "in": {"u": "stage.position"}})";

TEST(Units, AreSolvedThroughGainsSumsAndStates) {
  const auto plan = plan_of(diagram(servo, R"("stop": 1, "step": 0.001)"));
  EXPECT_EQ(unit_of(*plan, "error.sum"), "m");
  EXPECT_EQ(unit_of(*plan, "gain.y"), "N");
  EXPECT_EQ(unit_of(*plan, "stage.velocity"), "m/s");
  EXPECT_EQ(unit_of(*plan, "stage.acceleration"), "m/s^2");
  EXPECT_EQ(unit_of(*plan, "speed.y"), "m/s");
}

TEST(Units, OfAParameterWithAPrefixScaleItsNumber) {
  const RunResult result =
      run_of(diagram(R"("c": {"type": "Constant", "value": {"value": 5, "unit": "mm"}})"));
  EXPECT_EQ(signal(result, "c.y")[0], 0.005);
  EXPECT_EQ(result.recording.columns[1].unit, "m");
}

TEST(Units, AClashNamesBothEndsAndBothUnits) {
  EXPECT_EQ(problems_of(diagram(R"("length": {"type": "Constant", "value": {"value": 1, "unit": "m"}},
"sum": {"type": "Sum", "in": {"terms": ["length.y", "force.y"]}},
"force": {"type": "Constant", "value": {"value": 1, "unit": "N"}})")),
            R"(top.json:3:53: error: sum.terms [m] is wired to force.y [N]
  block: sum
  at: /blocks/sum/in/terms/1
  expected: a signal in m
  found: N
1 error)");
}

TEST(Units, AClashFarFromItsCauseIsFoundAtTheWireThatCannotBe) {
  // The mass is in kg, its force therefore in N; the gain says V.
  const std::string text =
      problems_of(diagram(R"("c": {"type": "Constant", "value": {"value": 1, "unit": "m"}},
"g": {"type": "Gain", "gain": {"value": 1, "unit": "V/m"}, "in": {"u": "c.y"}},
"stage": {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "initial_position": {"value": 1, "unit": "m"}, "in": {"force": "g.y"}})"));
  EXPECT_TRUE(has(text, "1 error")) << text;
  EXPECT_TRUE(has(text, "stage.force [N] is wired to g.y [V]")) << text;
}

TEST(Units, OfAParameterThatDoNotFitAreAnError) {
  const std::string text = problems_of(diagram(
      R"("x": {"type": "LowPass", "cutoff": {"value": 10, "unit": "m"}, "in": {"u": "c.time"}}, "c": {"type": "Clock"})"));
  EXPECT_TRUE(has(text, "the parameter \"cutoff\" has the wrong unit")) << text;
  EXPECT_TRUE(has(text, "expected: a number in 1/s")) << text;
  EXPECT_TRUE(has(text, "found:") && has(text, "m")) << text;
}

TEST(Units, HertzIsNoCutoffInRadiansWithoutSayingSo) {
  const std::string text =
      problems_of(diagram(R"("s": {"type": "Sine", "frequency": {"value": 10, "unit": "m"}})"));
  EXPECT_TRUE(has(text, "the parameter \"frequency\" has the wrong unit")) << text;
}

TEST(Units, InsideAListOfObjectsAreChecked) {
  const std::string text = problems_of(diagram(
      R"("stage": {"type": "Mass", "mass": {"value": 1, "unit": "kg"}, "initial_position": {"value": 0, "unit": "m"}, "in": {"force": "cogging.force"}},
"cogging": {"type": "CoggingForce", "pole_pitch": {"value": 22.5, "unit": "mm"}, "harmonics": [{"amplitude": {"value": 2, "unit": "V"}}], "in": {"position": "stage.position"}})"));
  EXPECT_TRUE(has(text, "error") && has(text, "V")) << text;
}

TEST(Units, DeclaredBySubdiagramsHoldAtTheirBorder) {
  DiagramFolder folder;
  folder.with(
      "axis.json",
      R"({"loopwright": 1, "inputs": {"force": {"unit": "N"}}, "outputs": {"same": {"source": "g.y", "unit": "N"}},
    "blocks": {"g": {"type": "Gain", "gain": {"value": 1, "unit": "1"}, "in": {"u": "force"}}}})");
  folder.with(
      "top.json",
      diagram(
          R"("c": {"type": "Constant", "value": {"value": 1, "unit": "V"}}, "axis": {"diagram": "axis.json", "in": {"force": "c.y"}})"));
  const std::string text = problems_in(folder);
  EXPECT_TRUE(has(text, "axis.force [N] is wired to c.y [V]")) << text;
}

TEST(Units, OfAnExpressionAreAsItsReadersNeedThem) {
  const auto plan = plan_of(
      diagram(R"("a": {"type": "Constant", "value": {"value": 1, "unit": "V"}}, "t": {"type": "Clock"},
"e": {"type": "Expression", "formula": "a*t", "names": ["a", "t"], "in": {"arguments": ["a.y", "t.time"]}},
"stage": {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "initial_position": {"value": 1, "unit": "m"}, "in": {"force": "e.y"}})"));
  EXPECT_EQ(unit_of(*plan, "e.y"), "N");
}

TEST(Units, ThatNobodyWroteAreUnknownNotWrong) {
  const auto plan = plan_of(diagram(
      R"("c": {"type": "Constant", "value": 1}, "g": {"type": "Gain", "gain": 2, "in": {"u": "c.y"}})"));
  EXPECT_EQ(unit_of(*plan, "g.y"), "?");
  EXPECT_FALSE(plan->log[0].unit_is_known);
}

TEST(Units, OfTheSameDimensionMayMeetWhateverTheirNames) {
  EXPECT_EQ(
      problems_of(diagram(
          R"("a": {"type": "Constant", "value": {"value": 1, "unit": "N*m"}}, "b": {"type": "Constant", "value": {"value": 1, "unit": "J"}},
    "sum": {"type": "Sum", "in": {"terms": ["a.y", "b.y"]}})")),
      "");
}

}  // namespace
}  // namespace loopwright
