#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright {

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

TEST(Comparison, NamesItsOperatorsWhenOneIsUnknown) {
  BlockUnderTest comparison("Comparison", R"({"operator": "="})");
  EXPECT_NE(comparison.problems().text().find("\"==\" or \"!=\""), std::string::npos)
      << comparison.problems().text();
}

}  // namespace loopwright
