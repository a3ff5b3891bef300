// Rates such as 1/min on wires, in expressions and in recorded columns.
#include <gtest/gtest.h>
#include "tests/engine/written_diagram.h"

namespace loopwright::scaled_rate_test {
namespace {

/// A constant n in 1/min, w in rad/s and k in 1/s, and a block that reads two wires.
std::string sum_of(const std::string& first, const std::string& second) {
  return diagram(R"("n": {"type": "Constant", "value": {"value": 60, "unit": "1/min"}},
"w": {"type": "Constant", "value": {"value": 1, "unit": "rad/s"}},
"k": {"type": "Constant", "value": {"value": 1, "unit": "1/s"}},
"g": {"type": "Gain", "gain": 2, "in": {"u": "n.y"}},
"sum": {"type": "Sum", "in": {"terms": [")" +
                 first + R"(", ")" + second + "\"]}}");
}

TEST(ScaledRate, OnAWireMeetsNoRadians) {
  for (const char* rate : {"n.y", "g.y"}) {
    for (const std::string& text : {problems_of(sum_of("w.y", rate)), problems_of(sum_of(rate, "w.y"))}) {
      EXPECT_TRUE(has(text, "[1/min]") && has(text, "[rad/s]")) << text;
      EXPECT_TRUE(has(text, "hint: revolutions per minute are rpm, and a plain rate is in 1/s")) << text;
    }
    EXPECT_EQ(problems_of(sum_of("k.y", rate)), "");
    EXPECT_EQ(problems_of(sum_of(rate, "k.y")), "");
  }
  EXPECT_EQ(problems_of(sum_of("k.y", "w.y")), "");
}

TEST(ScaledRate, OnAWireIsInSi) {
  const RunResult result = run_of(sum_of("n.y", "k.y"));
  EXPECT_DOUBLE_EQ(signal(result, "n.y")[0], 1);
  for (const Column& column : result.recording.columns) {
    if (column.name == "n.y") {
      EXPECT_EQ(column.unit, "1/s");
    }
  }
}

std::string cutoff_of(const std::string& expression) {
  return problems_of(diagram(
      R"("x": {"type": "LowPass", "cutoff": ")" + expression +
          R"(", "in": {"u": "t.time"}}, "t": {"type": "Clock"})",
      R"("stop": 1)",
      R"(, "parameters": {"n": {"value": 60, "unit": "1/min"}, "w": {"value": 1, "unit": "rad/s"}})"));
}

TEST(ScaledRate, NamesBothReadings) {
  const std::string text = cutoff_of("=n");
  EXPECT_TRUE(has(text, "cutoff: 60 1/min can mean two numbers here")) << text;
  EXPECT_TRUE(has(text, "expected: a number in rad/s")) << text;
  EXPECT_TRUE(
      has(text, "hint: revolutions make it 6.283 rad/s: write rpm; a plain rate makes it 1 rad/s: write 1/s"))
      << text;
}

TEST(ScaledRate, InAnExpressionIsQuestionedUnlessItIsMultipliedByPi) {
  for (const char* expression : {"=2*n", "= n ", "=max(n, 2*n)"})
    EXPECT_TRUE(has(cutoff_of(expression), "can mean two numbers here")) << cutoff_of(expression);
  EXPECT_TRUE(has(cutoff_of("=n+w"), "the expression adds a rate such as 1/min to rad/s or Hz"))
      << cutoff_of("=n+w");
  for (const char* expression : {"=2*pi*n", "=w+2*pi*n", "=w", "=w*(n/n)"})
    EXPECT_EQ(cutoff_of(expression), "") << expression;
}

TEST(ScaledRate, InAnExpressionBlockIsQuestioned) {
  const auto formula = [](const std::string& text) {
    return problems_of(diagram(R"("n": {"type": "Constant", "value": {"value": 60, "unit": "1/min"}},
"w": {"type": "Constant", "value": {"value": 1, "unit": "rad/s"}},
"e": {"type": "Expression", "formula": ")" +
                               text +
                               R"(", "names": ["n"], "in": {"arguments": ["n.y"]}},
"sum": {"type": "Sum", "in": {"terms": ["w.y", "e.y"]}})"));
  };
  EXPECT_TRUE(has(formula("3*n"), "[1/min]")) << formula("3*n");
  EXPECT_EQ(formula("2*pi*n"), "");
}

TEST(ScaledRate, InTheHeadingOfAColumnMeetsNoRadians) {
  const auto column = [](const std::string& heading, const std::string& unit) {
    DiagramFolder folder;
    folder.with("data.csv", "t," + heading + "\n0,60\n1,60\n");
    folder.with("top.json",
                diagram(R"("c": {"type": "RecordedColumn", "file": "data.csv", "column": "n")" + unit +
                        R"(}, "w": {"type": "Constant", "value": {"value": 1, "unit": "rad/s"}},
"sum": {"type": "Sum", "in": {"terms": ["w.y", "c.value"]}})"));
    return problems_in(folder);
  };
  EXPECT_TRUE(has(column("n [1/min]", ""), "c.value [1/min]")) << column("n [1/min]", "");
  EXPECT_TRUE(has(column("n", R"(, "unit": "1/min")"), "c.value [1/min]"));
  EXPECT_EQ(column("n [rpm]", ""), "");
  EXPECT_EQ(column("n [1/s]", ""), "");
}

TEST(ScaledRate, AsTheSpeedOfAShaftIsQuestioned) {
  const auto shaft = [](const std::string& unit) {
    return problems_of(diagram(R"("t": {"type": "Constant", "value": {"value": 1, "unit": "N*m"}},
"m": {"type": "Mass", "mass": {"value": 1, "unit": "kg*m^2"}, "initial_velocity": {"value": 60, "unit": ")" +
                               unit + R"("}, "in": {"force": "t.y"}})"));
  };
  EXPECT_TRUE(has(shaft("1/min"), "1/min")) << shaft("1/min");
  EXPECT_EQ(shaft("rpm"), "");
  EXPECT_EQ(shaft("1/s"), "");
}

}  // namespace
}  // namespace loopwright::scaled_rate_test
