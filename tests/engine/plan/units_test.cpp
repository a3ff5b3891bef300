// Units are derived along the wires. A conflict names both ends.
#include <gtest/gtest.h>
#include "tests/engine/written_diagram.h"

namespace loopwright::units_test {
namespace {

std::string unit_of(const Plan& plan, std::string_view port) {
  const auto numbers = plan.find(port);
  if (numbers.size() != 1) throw std::invalid_argument("no port " + std::string(port));
  const auto unit = plan.unit_of(numbers[0]);
  return unit ? to_string(*unit) : "?";
}

/// A force on a mass with a position controller: units are given at the mass and the reference only.
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
  // The mass is in kg, its force is therefore in N; the gain states V.
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
  EXPECT_TRUE(has(text, "expected: a number in rad/s")) << text;
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

TEST(Units, OfAnExpressionFollowFromItsArguments) {
  const std::string blocks =
      R"("a": {"type": "Constant", "value": {"value": 1, "unit": "V"}}, "t": {"type": "Clock"},
"e": {"type": "Expression", "formula": "a*t", "names": ["a", "t"], "in": {"arguments": ["a.y", "t.time"]}})";
  EXPECT_EQ(unit_of(*plan_of(diagram(blocks)), "e.y"), "V*s");
  const std::string text = problems_of(diagram(
      blocks +
      R"(, "stage": {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "initial_position": {"value": 1, "unit": "m"}, "in": {"force": "e.y"}})"));
  EXPECT_TRUE(has(text, "stage.force [N] is wired to e.y [V*s]")) << text;
}

TEST(Units, OfAnExpressionThatMixesThemAreNamedWithTheirPlace) {
  const std::string text =
      problems_of(diagram(R"("amps": {"type": "Constant", "value": {"value": 1, "unit": "A"}},
"metres": {"type": "Constant", "value": {"value": 1, "unit": "m"}},
"p": {"type": "Product", "in": {"factors": ["amps.y", "metres.y"]}},
"e": {"type": "Expression", "formula": "a+m", "names": ["a", "m"], "in": {"arguments": ["amps.y", "metres.y"]}},
"ok": {"type": "Sum", "in": {"terms": ["p.product", "metres.y", "e.y"]}})"));
  EXPECT_TRUE(has(text, "top.json:5:40: error: the formula mixes units")) << text;
  EXPECT_TRUE(has(text, "found: a+m with a in A, m in m")) << text;
  EXPECT_TRUE(has(text, "ok.terms [m*A] is wired to metres.y [m]")) << text;
  EXPECT_TRUE(has(text, "2 errors")) << text;
}

TEST(Units, OfProductsMultiplyAndDivide) {
  const auto plan = plan_of(diagram(R"("f": {"type": "Constant", "value": {"value": 1, "unit": "N"}},
"v": {"type": "Constant", "value": {"value": 2, "unit": "m/s"}},
"power": {"type": "Product", "in": {"factors": ["f.y", "v.y"]}},
"back": {"type": "Product", "operations": "*/", "in": {"factors": ["power.product", "f.y"]}})"));
  EXPECT_EQ(unit_of(*plan, "power.product"), "W");
  EXPECT_EQ(unit_of(*plan, "back.product"), "m/s");
}

TEST(Units, OfABareGainAreThoseOfItsInput) {
  const std::string ends = R"("a": {"type": "Constant", "value": {"value": 1, "unit": "A"}},
"stage": {"type": "Mass", "mass": {"value": 2, "unit": "kg"}, "initial_position": {"value": 1, "unit": "m"}, "in": {"force": "g.y"}},)";
  const std::string bare =
      problems_of(diagram(ends + R"("g": {"type": "Gain", "gain": 2, "in": {"u": "a.y"}})"));
  EXPECT_TRUE(has(bare, "stage.force [N] is wired to g.y [A]")) << bare;
  EXPECT_TRUE(has(bare, R"(hint: a bare gain keeps the unit of its input)")) << bare;
  EXPECT_EQ(problems_of(diagram(
                ends + R"("g": {"type": "Gain", "gain": {"value": 20, "unit": "N/A"}, "in": {"u": "a.y"}})")),
            "");
}

TEST(Units, OfBareFiltersAndMatricesAreThoseOfTheirInput) {
  const auto plan = plan_of(diagram(R"("a": {"type": "Constant", "value": {"value": 1, "unit": "A"}},
"t": {"type": "TransferFunction", "numerator": [1], "denominator": [1, 1], "in": {"u": "a.y"}},
"p": {"type": "StrictlyProperTransferFunction", "numerator": [{"value": 3, "unit": "N/A"}], "denominator": [1, 1], "in": {"u": "a.y"}},
"s": {"type": "StateSpace", "A": [[-1]], "B": [[1]], "C": [[1]], "D": [[0]], "in": {"u": "both.y"}},
"both": {"type": "Pack", "in": {"elements": ["a.y"]}},
"m": {"type": "MatrixGain", "matrix": [[{"value": 2, "unit": "V/A"}], [0]], "in": {"u": "both.y"}})"));
  EXPECT_EQ(unit_of(*plan, "t.y"), "A");
  EXPECT_EQ(unit_of(*plan, "p.y"), "N");
  EXPECT_EQ(unit_of(*plan, "s.y[0]"), "A");
  EXPECT_EQ(unit_of(*plan, "m.y[1]"), "V");
}

TEST(Units, OfAMatrixMustAgreeWhereTheyAreWritten) {
  const std::string text =
      problems_of(diagram(R"("a": {"type": "Constant", "value": {"value": 1, "unit": "A"}},
"both": {"type": "Pack", "in": {"elements": ["a.y"]}},
"m": {"type": "MatrixGain", "matrix": [[{"value": 2, "unit": "V/A"}], [7]], "in": {"u": "both.y"}})"));
  EXPECT_TRUE(has(text, "the parameter \"matrix\" has the wrong unit")) << text;
}

TEST(Units, OfSeveralUnknownsAreSolvedTogether) {
  // Each equation of the spring and the mass has several unknowns. With the push all are determined.
  const auto plan = plan_of(diagram(R"("push": {"type": "Step", "after": {"value": 10, "unit": "N"}},
"net": {"type": "Sum", "signs": "+-", "in": {"terms": ["push.y", "spring.force"]}},
"square": {"type": "Product", "in": {"factors": ["a.y", "b.y"]}},
"a": {"type": "Constant", "value": 2}, "b": {"type": "Constant", "value": 2},
"ratio": {"type": "Product", "operations": "*/", "in": {"factors": ["a.y", "b.y"]}},
"area": {"type": "Sum", "in": {"terms": ["square.product", "known.y"]}},
"known": {"type": "Constant", "value": {"value": 1, "unit": "m^2"}},
"one": {"type": "Sum", "in": {"terms": ["ratio.product", "plain.y"]}},
"plain": {"type": "Constant", "value": {"value": 1, "unit": "1"}},
"mass": {"type": "Mass", "mass": 0.5, "in": {"force": "net.sum"}},
"spring": {"type": "Spring", "stiffness": {"value": 0.18, "unit": "N/mm"}, "in": {"position": "mass.position"}})"));
  EXPECT_EQ(unit_of(*plan, "mass.position"), "m");
  EXPECT_EQ(unit_of(*plan, "a.y"), "m");
  EXPECT_EQ(unit_of(*plan, "b.y"), "m");
}

TEST(Units, ThatContradictEachOtherRoundALoopAreAnError) {
  const std::string text =
      problems_of(diagram(R"("g": {"type": "Gain", "gain": {"value": 2, "unit": "N/A"}, "in": {"u": "d.y"}},
"d": {"type": "UnitDelay", "sample_time": 0.1, "in": {"u": "g.y"}})"));
  EXPECT_TRUE(has(text, "the units contradict each other")) << text;
}

TEST(Units, ThatContradictEachOtherAroundAMassAreAnError) {
  const std::string text = problems_of(
      diagram(R"("mass": {"type": "Mass", "mass": {"value": 1, "unit": "kg"}, "in": {"force": "net.sum"}},
"spring": {"type": "Spring", "stiffness": {"value": 1, "unit": "V/m"}, "in": {"position": "mass.position"}},
"net": {"type": "Sum", "signs": "-", "in": {"terms": ["spring.force"]}})"));
  EXPECT_TRUE(has(text, "the units contradict each other")) << text;
}

TEST(Units, AreNotMissedWhereNoneAreWritten) {
  EXPECT_EQ(problems_of(diagram(R"("x": {"type": "Integrator", "initial": 1, "in": {"u": "v.y"}},
"v": {"type": "Integrator", "in": {"u": "pull.y"}}, "pull": {"type": "Gain", "gain": -4, "in": {"u": "x.y"}},
"a": {"type": "Integrator", "initial": 1, "in": {"u": "b.y"}}, "b": {"type": "Integrator", "in": {"u": "minus.sum"}},
"minus": {"type": "Sum", "signs": "-", "in": {"terms": ["a.y"]}})")),
            "");
}

TEST(Units, OfAnAngleAreShownAsRadians) {
  const auto plan = plan_of(diagram(R"("torque": {"type": "Constant", "value": {"value": 1, "unit": "N*m"}},
"rotor": {"type": "Mass", "mass": {"value": 1, "unit": "kg*m^2"}, "in": {"force": "torque.y"}},
"radius": {"type": "Constant", "value": {"value": 0.1, "unit": "m"}},
"rim": {"type": "Product", "in": {"factors": ["radius.y", "rotor.velocity"]}},
"belt": {"type": "Sum", "in": {"terms": ["speed.y", "rim.product"]}},
"speed": {"type": "Constant", "value": {"value": 1, "unit": "m/s"}})"));
  EXPECT_EQ(unit_of(*plan, "rotor.position"), "rad");
  EXPECT_EQ(unit_of(*plan, "rotor.velocity"), "rad/s");
  EXPECT_EQ(unit_of(*plan, "rotor.acceleration"), "rad/s^2");
  EXPECT_EQ(unit_of(*plan, "belt.sum"), "m/s");  // v = ω r
}

TEST(Units, OfAFrequencyAndOfRadiansDoNotMeetOnAWire) {
  const std::string sources = R"("c": {"type": "Chirp", "from": 1, "to": 2, "duration": 1},
"w": {"type": "Constant", "value": {"value": 1, "unit": "rad/s"}},)";
  const std::string text =
      problems_of(diagram(sources + R"("sum": {"type": "Sum", "in": {"terms": ["w.y", "c.frequency"]}})"));
  EXPECT_TRUE(has(text, "sum.terms [rad/s] is wired to c.frequency [Hz]")) << text;
  EXPECT_TRUE(has(text, "hint: hertz count cycles")) << text;
  EXPECT_EQ(problems_of(diagram(sources + R"json(
"g": {"type": "Gain", "gain": {"value": "=2*pi", "unit": "rad/(Hz*s)"}, "in": {"u": "c.frequency"}},
"sum": {"type": "Sum", "in": {"terms": ["w.y", "g.y"]}})json")),
            "");
}

TEST(Units, OfWiresThatNothingDecidesAreCounted) {
  const auto plan = plan_of(diagram(
      R"("c": {"type": "Constant", "value": 1}, "g": {"type": "Gain", "gain": 2, "in": {"u": "c.y"}},
"t": {"type": "Clock"}, "s": {"type": "Sum", "in": {"terms": ["g.y"]}})",
      R"("stop": 1)", R"(, "log": ["t.time"])"));
  EXPECT_EQ(plan->without_unit.count, 2u);  // no block reads s.sum
  EXPECT_EQ(to_string(plan->without_unit), "2 wires without a unit: c.y, g.y");
  Problems problems;
  refuse(plan->without_unit, problems);
  EXPECT_TRUE(has(problems.text(), "nothing decides the unit of g.y")) << problems.text();
  EXPECT_TRUE(has(problems.text(), "2 errors")) << problems.text();
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
}  // namespace loopwright::units_test
