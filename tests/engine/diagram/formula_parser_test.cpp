#include "engine/diagram/formula_parser.h"
#include <gtest/gtest.h>
#include <cmath>
#include <set>
#include "models/real/double_functions.h"

namespace loopwright::formula_parser_test {
namespace {

double value_of(const std::string& formula) {
  FormulaParser parser;
  parser.set_formula(formula);
  return parser.Eval();
}
std::string complaint_about(const std::string& formula) {
  try {
    value_of(formula);
  } catch (const mu::ParserError& error) {
    return FormulaParser::message_of(error);
  }
  return {};
}

// Functions that a newer muParser adds must be reviewed: does the C library compute them?
TEST(FormulaParser, LeavesNoFunctionToTheCLibrary) {
  const std::set<std::string> own{"sin",   "cos",  "tan",  "asin", "acos",  "atan",
                                  "atan2", "sinh", "cosh", "tanh", "asinh", "acosh",
                                  "atanh", "exp",  "ln",   "log",  "log2",  "log10"};
  const std::set<std::string> exact{"sqrt", "abs", "sign", "rint", "min", "max", "sum", "avg"};
  FormulaParser parser;
  for (const auto& [name, function] : parser.GetFunDef())
    EXPECT_TRUE(own.contains(name) || exact.contains(name)) << name;
}

TEST(FormulaParser, CallsTheFunctionsOfTheSimulation) {
  for (const double x : {0.1, 0.3, 0.7, 0.99}) {
    const std::string argument = "(" + std::to_string(x) + ")";
    EXPECT_EQ(value_of("sin" + argument), sine(x));
    EXPECT_EQ(value_of("tan" + argument), tangent(x));
    EXPECT_EQ(value_of("asin" + argument), arc_sine(x));
    EXPECT_EQ(value_of("exp" + argument), exponential(x));
    EXPECT_EQ(value_of("ln" + argument), natural_logarithm(x));
    EXPECT_EQ(value_of("atanh" + argument), area_tangent(x));
    EXPECT_EQ(value_of("atan2(0.5, -" + std::to_string(x) + ")"), arc_tangent2(0.5, -x));
  }
}

TEST(FormulaParser, RaisesToPowersAsMuparserDoes) {
  const char* const formulas[] = {
      "2^3",     "-2^2",       "2^-2",      "2^3^2", "10^3^0", "4^0.5",   "(-8)^3",
      "3*-2^2",  "2^-2*2",     "(1+2)^2*3", "0^0",   "1e3^2",  "2 ^ - 2", "1^2==1 ? 4^2 : 5",
      "9^0.5+1", "2*3^2-4/2^2"};
  for (const char* formula : formulas) {
    mu::Parser theirs;
    theirs.SetExpr(formula);
    EXPECT_EQ(value_of(formula), theirs.Eval()) << formula;
  }
}

TEST(FormulaParser, SpeaksOfOperatorsAsTheyWereWritten) {
  EXPECT_NE(complaint_about("2^^3").find('^'), std::string::npos) << complaint_about("2^^3");
  EXPECT_EQ(complaint_about("2^^3").find('~'), std::string::npos) << complaint_about("2^^3");
  EXPECT_NE(complaint_about("2~3"), "");
}

}  // namespace
}  // namespace loopwright::formula_parser_test
