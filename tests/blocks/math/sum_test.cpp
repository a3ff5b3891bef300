#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::sum_test {

TEST(Sum, AddsAnyNumberOfTermsWithoutSigns) {
  BlockUnderTest sum("Sum");
  sum.inputs("terms") = {1, 2, 4, 8};
  sum.evaluate();
  EXPECT_EQ(sum.output("sum"), 15);
}

TEST(Sum, SubtractsWhereTheSignSaysSo) {
  BlockUnderTest sum("Sum", R"({"signs": "+--+"})");
  sum.inputs("terms") = {1, 2, 4, 8};
  sum.evaluate();
  EXPECT_EQ(sum.output("sum"), 3);
}

TEST(Sum, TakesAsManyTermsAsItHasSigns) {
  BlockUnderTest sum("Sum", R"({"signs": "+-"})");
  EXPECT_EQ(sum.inputs("terms").size(), 2u);
}

TEST(Sum, RefusesOtherSigns) {
  BlockUnderTest sum("Sum", R"({"signs": "+*"})");
  EXPECT_NE(sum.problems().text().find("signs may only hold + and -"), std::string::npos)
      << sum.problems().text();
}

}  // namespace loopwright::sum_test
