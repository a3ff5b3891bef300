#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::saturation_test {

TEST(Saturation, HoldsASignalWithinItsLimits) {
  BlockUnderTest limit("Saturation", R"({"low": -1, "high": 2})");
  const double u[] = {-5, -1, 0.5, 2, 9}, expected[] = {-1, -1, 0.5, 2, 2};
  for (int i = 0; i < 5; ++i) {
    limit.input("u") = u[i];
    limit.evaluate();
    EXPECT_EQ(limit.output("y"), expected[i]);
  }
}

TEST(Saturation, HasNoLimitThatIsNotGiven) {
  BlockUnderTest limit("Saturation", R"({"high": 2})");
  limit.input("u") = -1e200;
  limit.evaluate();
  EXPECT_EQ(limit.output("y"), -1e200);
  limit.crossings();
  EXPECT_TRUE(std::isfinite(limit.crossing("low")));
}

TEST(Saturation, LetsNoNumberHideBehindALimit) {
  BlockUnderTest limit("Saturation", R"({"low": -1, "high": 2})");
  limit.input("u") = std::nan("");
  limit.evaluate();
  EXPECT_TRUE(std::isnan(limit.output("y")));
}

TEST(Saturation, ItsLimitsAreCrossings) {
  BlockUnderTest limit("Saturation", R"({"low": -1, "high": 2})");
  const double u[] = {-1.5, 0, 2.5}, low[] = {-0.5, 1, 3.5}, high[] = {-3.5, -2, 0.5};
  for (int i = 0; i < 3; ++i) {
    limit.input("u") = u[i];
    limit.crossings();
    EXPECT_EQ(limit.crossing("low"), low[i]);
    EXPECT_EQ(limit.crossing("high"), high[i]);
  }
}

TEST(Saturation, RefusesLimitsInTheWrongOrder) {
  BlockUnderTest limit("Saturation", R"({"low": 3, "high": 2})");
  EXPECT_NE(limit.problems().text().find("lies above the upper one"), std::string::npos)
      << limit.problems().text();
}

}  // namespace loopwright::saturation_test
