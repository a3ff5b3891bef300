#include "engine/diagram/formula_steps.h"
#include <gtest/gtest.h>
#include <bit>
#include <cmath>
#include <numbers>
#include "engine/diagram/formula_parser.h"

namespace loopwright::formula_steps_test {
namespace {

const std::vector<std::string_view> names{"x", "y", "k"};

double by_parser(const std::string& formula, std::vector<double> values) {
  FormulaParser parser;
  parser.DefineConst("pi", std::numbers::pi);
  for (size_t i = 0; i < names.size(); ++i) parser.DefineVar(std::string(names[i]), &values[i]);
  parser.set_formula(formula);
  return parser.Eval();
}

TEST(FormulaSteps, GiveTheBitsOfTheParser) {
  const char* const formulas[] = {"x",
                                  "3",
                                  "-x",
                                  "+x - -y",
                                  "x - y - k",
                                  "x / y / k",
                                  "x - (y - k)",
                                  "-x^2",
                                  "2^3^y",
                                  "x^-2",
                                  "(x + k*y^2*sin(x) + k*sin(x)*cos(x) - cos(x)*y/k)/(k + y*sin(x)^2)",
                                  "x*y + x*y",
                                  "x < y",
                                  "x <= x",
                                  "x > y && y < k || x == 3",
                                  "!(x != y)",
                                  "min(x, y, k) + max(1, x) - sum(x, y) + avg(x, y, k)",
                                  "sqrt(abs(x)) + sign(y) - rint(k)",
                                  "tan(x) + atan2(y, x) + tanh(k) + asinh(y)",
                                  "2*pi*x + _e",
                                  "exp(-y^2)",
                                  "ln(abs(x) + 1) + log2(2 + y^2) + log10(3 + abs(k))",
                                  "1e-3*x - 2.5E2",
                                  "x*-y",
                                  "x+-y",
                                  "log(4)",
                                  "3*x*2"};
  for (const char* formula : formulas) {
    std::optional<FormulaSteps> steps = FormulaSteps::of(formula, names);
    ASSERT_TRUE(steps) << formula;
    for (const std::vector<double>& values :
         {std::vector{0.7, -1.3, 2.0}, std::vector{-4.0, 0.0, 1e-3}, std::vector{3.0, 1e7, -0.2}}) {
      std::ranges::copy(values, steps->variables().begin());
      const double a = steps->value(), b = by_parser(formula, values);
      EXPECT_TRUE(std::bit_cast<uint64_t>(a) == std::bit_cast<uint64_t>(b) ||
                  (std::isnan(a) && std::isnan(b)))
          << formula << " is " << a << " instead of " << b;
    }
  }
}

TEST(FormulaSteps, FollowConstantsOnlyWhenTheyAreTold) {
  std::optional<FormulaSteps> steps = FormulaSteps::of("x*sin(k)^2 + max(k, y, 1)", names);
  ASSERT_TRUE(steps);
  std::ranges::copy(std::vector{2.0, 3.0, 4.0}, steps->variables().begin());
  steps->keep_constant_from(2);
  EXPECT_EQ(steps->value(), by_parser("x*sin(k)^2 + max(k, y, 1)", {2, 3, 4}));
  steps->variables()[0] = 5, steps->variables()[1] = 7;
  EXPECT_EQ(steps->value(), by_parser("x*sin(k)^2 + max(k, y, 1)", {5, 7, 4}));
  steps->variables()[2] = 6;
  steps->keep_constant_from(2);
  EXPECT_EQ(steps->value(), by_parser("x*sin(k)^2 + max(k, y, 1)", {5, 7, 6}));
}

// It joins numbers with what they multiply.
TEST(FormulaSteps, LeaveToTheParserWhatItComputesOtherwise) {
  EXPECT_EQ(by_parser("0*x", {-1, 0, 0}), 0);
  EXPECT_FALSE(FormulaSteps::of("0*x", names));
  EXPECT_FALSE(FormulaSteps::of("sqrt(x - 1000)", names));  // no value that is tried is a number
}

// It computes one of the two, and the other one may stop it.
TEST(FormulaSteps, LeaveChoicesToTheParser) { EXPECT_FALSE(FormulaSteps::of("x > 0 ? y : k", names)); }

TEST(FormulaSteps, AreNoneOfWhatCannotBeRead) {
  for (const char* formula : {"", "x +", "speed", "x = 3", "sinh", "\"x\"", "min()"})
    EXPECT_FALSE(FormulaSteps::of(formula, names)) << formula;
}

}  // namespace
}  // namespace loopwright::formula_steps_test
