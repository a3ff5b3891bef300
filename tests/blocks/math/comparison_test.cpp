#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::comparison_test {

TEST(Comparison, AsksWhatItsOperatorSays) {
  const char* operators[] = {"<", "<=", ">", ">=", "==", "!="};
  const double less[] = {1, 1, 0, 0, 0, 1}, equal[] = {0, 1, 0, 1, 1, 0}, greater[] = {0, 0, 1, 1, 0, 1};
  for (int i = 0; i < 6; ++i) {
    BlockUnderTest comparison("Comparison", R"({"operator": ")" + std::string(operators[i]) + "\"}");
    comparison.input("b") = 2;
    for (auto [a, expected] :
         {std::pair(1.0, less[i]), std::pair(2.0, equal[i]), std::pair(3.0, greater[i])}) {
      comparison.input("a") = a;
      comparison.evaluate();
      EXPECT_EQ(comparison.output("y"), expected) << a << operators[i] << 2;
    }
  }
}

TEST(Comparison, ComparesWithZeroWhenTheRightSideIsLeftOut) {
  BlockUnderTest comparison("Comparison", R"({"operator": ">"})");
  comparison.input("a") = 1e-9;
  comparison.evaluate();
  EXPECT_EQ(comparison.output("y"), 1);
}

TEST(Comparison, EveryChangeOfItsAnswerChangesTheSignOfACrossing) {
  BlockUnderTest comparison("Comparison", R"({"operator": "=="})");
  const auto crossings = [&](double a) {
    comparison.input("a") = a;
    comparison.crossings();
    return std::pair(comparison.crossing("above") > 0, comparison.crossing("below") > 0);
  };
  EXPECT_EQ(crossings(-1e-200), std::pair(false, false));
  EXPECT_EQ(crossings(0), std::pair(false, true));
  EXPECT_EQ(crossings(1e-200), std::pair(true, true));
}

TEST(Comparison, WithHysteresisHoldsUntilTheBorderIsFarBehind) {
  const double a[] = {2.4, 2, 2.1, 1.6, 2.05, 1.4, 1.9, 2.1};
  const double greater[] = {1, 1, 1, 1, 1, 0, 0, 1};  // above 2, until below 1.5
  const double less[] = {0, 0, 0, 1, 1, 1, 1, 1};     // below 2, until above 2.5
  BlockUnderTest above("Comparison", R"({"operator": ">", "hysteresis": 0.5})"),
      below("Comparison", R"({"operator": "<", "hysteresis": 0.5})");
  above.input("b") = below.input("b") = 2;
  for (int i = 0; i < 8; ++i) {
    above.input("a") = below.input("a") = a[i];
    above.evaluate(i), below.evaluate(i);
    EXPECT_EQ(above.output("y"), greater[i]) << i;
    EXPECT_EQ(below.output("y"), less[i]) << i;
    above.crossings(), below.crossings();
    EXPECT_EQ(above.crossing("above") > 0, greater[i] > 0) << i;
    EXPECT_EQ(below.crossing("below") < 0, less[i] > 0) << i;
  }
}

TEST(Comparison, OnlyAnInequalityHasHysteresis) {
  BlockUnderTest equal("Comparison", R"({"operator": "==", "hysteresis": 0.5})");
  EXPECT_NE(equal.problems().text().find("only an inequality"), std::string::npos);
}

TEST(Comparison, NamesItsOperatorsWhenOneIsUnknown) {
  BlockUnderTest comparison("Comparison", R"({"operator": "="})");
  EXPECT_NE(comparison.problems().text().find("\"==\" or \"!=\""), std::string::npos)
      << comparison.problems().text();
}

}  // namespace loopwright::comparison_test
