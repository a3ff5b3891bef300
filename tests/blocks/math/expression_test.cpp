#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::expression_test {

TEST(Expression, EvaluatesItsFormula) {
  BlockUnderTest formula("Expression",
                         R"({"formula": "(c > 1 ? 100 : 0) + a * sin(pi*b) ", "names": ["a", "b", "c"]})");
  formula.inputs("arguments") = {3, 0.5, 2};
  formula.evaluate();
  EXPECT_DOUBLE_EQ(formula.output("y"), 103);
  formula.inputs("arguments") = {4, 0.5, 0};
  formula.evaluate();
  EXPECT_DOUBLE_EQ(formula.output("y"), 4);
}

TEST(Expression, TakesASignalForEachName) {
  EXPECT_EQ(
      BlockUnderTest("Expression", R"({"formula": "x+y", "names": ["x", "y"]})").inputs("arguments").size(),
      2u);
}

TEST(Expression, StopsTheRunWhenTheResultIsNoNumber) {
  BlockUnderTest formula("Expression", R"({"formula": "1/x", "names": ["x"]})");
  formula.input("arguments") = 0;
  formula.evaluate();
  EXPECT_EQ(formula.fault(), "the formula gave a non-finite number");
}

TEST(Expression, PointsAtTheMistakeInAFormula) {
  BlockUnderTest formula("Expression", R"({"formula": "x + spede", "names": ["x"]})");
  const std::string text = formula.problems().text();
  EXPECT_NE(text.find("the formula cannot be read"), std::string::npos) << text;
  EXPECT_NE(text.find("spede"), std::string::npos) << text;
  EXPECT_NE(text.find("settings.json:1:18"), std::string::npos) << text;  // position of spede
}

TEST(Expression, RefusesFormulasThatAreIncomplete) {
  for (const char* text : {"", "x +", "sin(", "(x", "x y", "x; y", "1..2"}) {
    BlockUnderTest formula("Expression", R"({"names": ["x"], "formula": ")" + std::string(text) + "\"}");
    EXPECT_TRUE(formula.problems().has_errors()) << text;
  }
}

TEST(Expression, RefusesNamesThatAreNone) {
  for (const char* names : {R"(["2x"])", R"(["a b"])", R"([""])", R"(["x", "x"])", R"(["pi"])"}) {
    BlockUnderTest formula("Expression", R"({"formula": "1", "names": )" + std::string(names) + "}");
    EXPECT_NE(formula.problems().text().find("/names"), std::string::npos) << names << "\n"
                                                                           << formula.problems().text();
  }
}

TEST(Expression, TwoBlocksDoNotShareTheirVariables) {
  BlockUnderTest first("Expression", R"({"formula": "x", "names": ["x"]})"),
      second("Expression", R"({"formula": "-x", "names": ["x"]})");
  first.input("arguments") = 1;
  second.input("arguments") = 2;
  first.evaluate();
  second.evaluate();
  EXPECT_EQ(first.output("y"), 1);
  EXPECT_EQ(second.output("y"), -2);
}

}  // namespace loopwright::expression_test
