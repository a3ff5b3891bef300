#include "engine/diagram/expression.h"
#include <cmath>
#include <gtest/gtest.h>
#include <map>

namespace loopwright::expression_test {
namespace {

const std::map<std::string, Quantity> parameters = {
    {"mass", {0.25, parse_unit("kg")}},
    {"damping", {3.0, parse_unit("N*s/m")}},
    {"travel", {0.1, parse_unit("m")}},
    {"speed", {2.0, parse_unit("m/s")}},
    {"cutoff", {251.3, parse_unit("rad/s")}},
    {"period", {0.5, parse_unit("s")}},
    {"count", {3.0, std::nullopt}},
    {"ratio", {0.5, parse_unit("1")}},
    {"payload", {0.0, parse_unit("kg")}},
    {"angle", {0.3, parse_unit("rad")}},
    {"zero", {0.0, std::nullopt}},
    {"gap", {-0.1, parse_unit("m")}},
};

struct Outcome {
  std::optional<Quantity> quantity;
  std::string problems;
};

Outcome result_of(std::string_view expression) {
  Problems problems;
  const auto file =
      std::make_shared<SourceFile>(SourceFile{"f.json", "{\"k\": \"=" + std::string(expression) + "\"}"});
  ExpressionSite site{{file, 6}, "stage", [&](const NameUse& use, const Place& place) -> const Quantity* {
                        const auto found = parameters.find(std::string(use.name));
                        if (found != parameters.end()) return &found->second;
                        problems.error(place, "/k", "stage", "unknown " + std::string(use.name));
                        return nullptr;
                      }};
  Outcome outcome{evaluate(expression, site, problems), {}};
  outcome.problems = problems.text();
  return outcome;
}

void expect(std::string_view expression, double number, std::string_view unit) {
  const auto [quantity, problems] = result_of(expression);
  ASSERT_TRUE(quantity) << expression << "\n" << problems;
  EXPECT_DOUBLE_EQ(quantity->number, number) << expression;
  EXPECT_EQ(quantity->unit ? to_string(*quantity->unit) : "bare", unit) << expression;
  EXPECT_EQ(problems, "");
}

std::string problem_of(std::string_view expression) {
  const auto [quantity, problems] = result_of(expression);
  EXPECT_FALSE(quantity) << expression;
  return problems;
}

TEST(Expression, CalculatesNumbers) {
  const double pi = std::acos(-1.0);
  expect("2*pi*40", 80 * pi, "bare");
  expect("1.5e-3 + 2E2", 200.0015, "bare");
  expect("sqrt(2)^2", std::pow(std::sqrt(2.0), 2), "bare");
  expect("max(1, count, 2) + min(4, 5)", 7, "bare");
  expect("count > 2 ? 10 : 20", 10, "bare");
  expect("count > 2 && zero == 0 ? 1 : 0", 1, "bare");
  expect("atan2(1, 1)", pi / 4, "bare");
  expect("-2^2", -4, "bare");
  expect("e", std::exp(1.0), "bare");
  expect("ln(e)", 1, "bare");
}

TEST(ExpressionUnit, FollowsProductsPowersAndRoots) {
  expect("mass * speed^2 / 2", 0.5, "N*m");
  expect("damping * speed", 6, "N");
  expect("damping / mass", 12, "1/s");
  expect("sqrt(travel^2)", 0.1, "m");
  expect("travel^(1/3)", std::pow(0.1, 1.0 / 3), "m^(1/3)");
  expect("1 / period", 2, "1/s");
  expect("mass * cutoff^2", 0.25 * 251.3 * 251.3, "N/m");
  expect("travel^count", std::pow(0.1, 3.0), "m^3");
}

TEST(ExpressionUnit, IsKeptBySumsOfOneUnit) {
  expect("travel + speed*period", 1.1, "m");
  expect("max(travel, speed*period)", 1.0, "m");
  expect("abs(-travel)", 0.1, "m");
  expect("travel > 2*travel ? travel : speed*period", 1.0, "m");
  expect("mass + payload", 0.25, "kg");
}

TEST(ExpressionUnit, OfOneNameIsThatOfTheParameter) {
  expect("damping", 3, "N*s/m");
  expect(" damping ", 3, "N*s/m");
  expect("payload", 0, "kg");
  expect("count", 3, "bare");
  expect("ratio", 0.5, "1");
}

TEST(ExpressionUnit, CancelsToADimensionlessNumber) {
  expect("travel / (speed*period)", 0.1, "1");
  expect("sin(angle)", std::sin(0.3), "1");
  expect("exp(-travel/(speed*period))", std::exp(-0.1), "1");
  expect("ratio * count", 1.5, "1");
  expect("mass * ratio * count", 0.375, "kg");
}

TEST(ExpressionUnit, DoesNotDependOnTheValuesOfTheParameters) {
  expect("payload * speed", 0, "N*s");
  expect("sqrt(gap^2)", 0.1, "m");
}

TEST(ExpressionUnit, OfAZeroFitsEveryUser) { expect("0 * mass", 0, "bare"); }

TEST(ExpressionErrors, ReportMixedUnits) {
  EXPECT_EQ(problem_of("mass + travel"),
            "f.json:1:9: error: the expression mixes units\n  block: stage\n  at: /k\n"
            "  found: =mass + travel with mass in kg, travel in m\n"
            "  hint: a number can be given a unit as a parameter: {\"value\": 3, \"unit\": \"m\"}\n1 error");
  for (const auto* mixed : {"travel + 1", "travel + 1e-10", "sin(travel)", "exp(40*period)",
                            "payload + travel", "mass > travel ? mass : travel",
                            "travel > 0.5 ? mass : travel", "speed^travel", "travel + count", "max(mass, 3)"})
    EXPECT_NE(problem_of(mixed).find("the expression mixes units"), std::string::npos) << mixed;
}

TEST(ExpressionErrors, PointAtUnknownNamesAndFunctions) {
  EXPECT_EQ(problem_of("2*mas + bar"),
            "f.json:1:11: error: unknown mas\n  block: stage\n  at: /k\nf.json:1:17: error: unknown bar\n  "
            "block: stage\n  at: /k\n2 errors");
  EXPECT_EQ(problem_of("1 + sqr(2)"),
            "f.json:1:13: error: there is no function \"sqr\"\n  block: stage\n  at: /k\n  found: =1 + "
            "sqr(2)\n  hint: did you mean \"sqrt\"?\n1 error");
}

TEST(ExpressionErrors, ReportResultsThatAreNotFinite) {
  EXPECT_EQ(
      problem_of("count/zero"),
      "f.json:1:9: error: the result of the expression is not a finite number\n  block: stage\n  at: /k\n"
      "  found: =count/zero, which is inf with count = 3, zero = 0\n1 error");
  EXPECT_NE(problem_of("sqrt(-1)").find("not a finite number"), std::string::npos);
  EXPECT_NE(problem_of("1e308*10").find("not a finite number"), std::string::npos);
}

TEST(ExpressionErrors, SayInPlainWordsWhatCannotBeRead) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "the expression is empty"},
      {"  ", "the expression is empty"},
      {"1 +", "the expression ends too early"},
      {"(1 + 2", "a closing parenthesis is missing"},
      {"1 + 2)", "a parenthesis stands at a wrong place"},
      {"2 mass", "an operator is missing"},
      {"2 * * 3", "an operator stands at a wrong place"},
      {"min()", "a function has too few arguments"},
      {"sin(1, 2)", "a function has too many arguments"},
      {"1, 2", "a comma stands at a wrong place"},
      {"mass = 3", "an expression cannot assign"},
      {"1 ? 2", "a condition is not of the form a ? b : c"},
      {"mass.x", "a character has no meaning in an expression"},
      {"\"abc\"", "a character has no meaning in an expression"},
      {"$", "a character has no meaning in an expression"},
      {"µ", "a character has no meaning in an expression"},
  };
  for (const auto& [expression, message] : cases)
    EXPECT_NE(problem_of(expression).find(message), std::string::npos) << expression << "\n"
                                                                       << problem_of(expression);
}

TEST(ExpressionErrors, LengthHasALimit) {
  EXPECT_NE(problem_of(std::string(100'000, '(')).find("longer than 1000 characters"), std::string::npos);
  EXPECT_NE(problem_of(std::string(999, '(')), "");
}

TEST(NamesIn, AreFoundInOrderWithoutNumbersAndConstants) {
  const auto uses = names_in("2*pi*alpha + 1e5*sin (b_2) + e - 1e + x1");
  std::string names;
  for (const NameUse& use : uses) names += std::string(use.name) + (use.is_function ? "() " : " ");
  EXPECT_EQ(names, "alpha sin() b_2 x1 ");
}

/// A deterministic sequence of strings that resemble expressions: none may crash or hang.
TEST(Expression, SurvivesNonsense) {
  const std::string_view pieces[] = {"mass",  "travel", "(", ")", "+",   "-",  "*",    "/",    "^",
                                     "?",     ":",      ",", "1", "1e3", ".",  "sin(", "max(", "&&",
                                     "||",    "==",     "<", "!", "\"",  "pi", " ",    "=",    "0",
                                     "count", "if(",    "e", "µ", "'",   "\\", "[",    "#"};
  uint64_t state = 1;
  const auto next = [&state](size_t n) {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    return static_cast<size_t>(state >> 33) % n;
  };
  int results = 0, refusals = 0;
  for (int i = 0; i < 20000; ++i) {
    std::string expression;
    for (size_t n = 1 + next(12); n > 0; --n) expression += pieces[next(std::size(pieces))];
    const auto [quantity, problems] = result_of(expression);
    EXPECT_NE(quantity.has_value(), !problems.empty()) << expression;
    ++(quantity ? results : refusals);
  }
  EXPECT_GT(results, 100);
  EXPECT_GT(refusals, 1000);
}

}  // namespace
}  // namespace loopwright::expression_test
