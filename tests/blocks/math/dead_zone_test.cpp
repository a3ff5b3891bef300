#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::dead_zone_test {

TEST(DeadZone, GivesTheDistanceFromTheZone) {
  BlockUnderTest zone("DeadZone", R"({"low": -1, "high": 2})");
  const double u[] = {-5, -1, 0.5, 2, 9}, expected[] = {-4, 0, 0, 0, 7};
  for (int i = 0; i < 5; ++i) {
    zone.input("u") = u[i];
    zone.evaluate();
    EXPECT_EQ(zone.output("y"), expected[i]);
  }
}

TEST(DeadZone, TheEndsOfTheZoneAreCrossings) {
  BlockUnderTest zone("DeadZone", R"({"low": -1, "high": 2})");
  zone.input("u") = 2.5;
  zone.crossings();
  EXPECT_EQ(zone.crossing("low"), 3.5);
  EXPECT_EQ(zone.crossing("high"), 0.5);
}

TEST(DeadZone, RefusesAZoneThatEndsBeforeItBegins) {
  BlockUnderTest zone("DeadZone", R"({"low": 3, "high": 2})");
  EXPECT_NE(zone.problems().text().find("lies above the upper one"), std::string::npos)
      << zone.problems().text();
}

}  // namespace loopwright::dead_zone_test
