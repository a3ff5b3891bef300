#include <gmock/gmock.h>
#include <random>
#include "tests/blocks/block_under_test.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::trigonometry_test {
namespace {

struct Case {
  const char* name;
  long double (*reference)(long double);  // libm in long double
  double low, high;
};
const Case cases[] = {{"sin", sinl, -50, 50},   {"cos", cosl, -50, 50},   {"tan", tanl, -50, 50},
                      {"asin", asinl, -1, 1},   {"acos", acosl, -1, 1},   {"atan", atanl, -50, 50},
                      {"sinh", sinhl, -20, 20}, {"cosh", coshl, -20, 20}, {"tanh", tanhl, -20, 20}};

std::string settings(const char* function) { return fmt::format(R"({{"function": "{}"}})", function); }

TEST(Trigonometry, AgreesWithTheCLibrary) {
  for (const Case& c : cases) {
    BlockUnderTest block("Trigonometry", settings(c.name));
    std::mt19937_64 random(7);
    for (int i = 0; i < 10000; ++i) {
      const double u = std::uniform_real_distribution(c.low, c.high)(random);
      block.input("u") = u;
      block.evaluate();
      const double expected = double(c.reference(u));
      ASSERT_NEAR(block.output("y"), expected,
                  4 * (std::nextafter(std::fabs(expected), 1e300) - std::fabs(expected)))
          << c.name << " of " << u;
    }
    EXPECT_EQ(block.fault(), "");
  }
}

TEST(Trigonometry, StopsWhereThereIsNoValue) {
  for (const auto& [name, u] :
       {std::pair("asin", 1.1), {"acos", -1.1}, {"sinh", 800.0}, {"sin", std::nan("")}}) {
    BlockUnderTest block("Trigonometry", settings(name));
    block.input("u") = u;
    block.evaluate();
    EXPECT_EQ(block.fault(), "the function has no finite value there") << name;
  }
}

TEST(Trigonometry, TheTangentTellsItsPoles) {
  BlockUnderTest tangent("Trigonometry", settings("tan")), sine("Trigonometry", settings("sin"));
  EXPECT_TRUE(tangent.info().may_cross);
  const auto side = [&](double u) {
    tangent.input("u") = u;
    tangent.crossings();
    return tangent.crossing("pole") > 0;
  };
  for (double pole : {-1.5 * pi, -0.5 * pi, 0.5 * pi, 1.5 * pi})
    EXPECT_NE(side(pole - 1e-9), side(pole + 1e-9));
}

TEST(Trigonometry, ChecksAngles) {
  const auto text = [](const char* function, const char* unit) {
    return problems_of(diagram(fmt::format(
        R"("c": {{"type": "Constant", "value": {{"value": 0.5, "unit": "{}"}}}},
           "f": {{"type": "Trigonometry", "function": "{}", "in": {{"u": "c.y"}}}})",
        unit, function)));
  };
  EXPECT_EQ(text("sin", "rad"), "");
  EXPECT_EQ(text("sin", "deg"), "");
  EXPECT_EQ(text("acos", "1"), "");
  EXPECT_NE(text("sin", "m"), "");
  EXPECT_NE(text("acos", "m"), "");
  const auto plan = plan_of(diagram(R"("c": {"type": "Constant", "value": 0.5},
      "f": {"type": "Trigonometry", "function": "acos", "in": {"u": "c.y"}})"));
  EXPECT_EQ(to_string(plan->unit_of(plan->find("f.y")[0]).value()), "rad");
}

}  // namespace
}  // namespace loopwright::trigonometry_test
