#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::relay_test {

TEST(Relay, SwitchesWithHysteresis) {
  BlockUnderTest relay("Relay", R"({"switch_on": 1, "switch_off": -1, "on": 5, "off": -5})");
  const double u[] = {0, 1, 1.1, 0, -1, -1.1, 0, 2}, expected[] = {-5, -5, 5, 5, 5, -5, -5, 5};
  for (int i = 0; i < 8; ++i) {
    relay.input("u") = u[i];
    relay.evaluate();
    EXPECT_EQ(relay.output("y"), expected[i]) << "at step " << i;
  }
}

TEST(Relay, MayStartOn) {
  BlockUnderTest relay("Relay", R"({"switch_on": 1, "switch_off": -1, "starts_on": true})");
  relay.evaluate();
  EXPECT_EQ(relay.output("y"), 1);
}

TEST(Relay, HoldsInsideASolverStepUntilItsThresholdIsCrossed) {
  BlockUnderTest relay("Relay", R"({"switch_on": 1, "switch_off": -1})");
  relay.input("u") = 1;  // on the threshold, not above
  relay.evaluate();
  relay.crossings();
  EXPECT_LT(relay.crossing("threshold"), 0);
  relay.input("u") = 1.5;
  relay.evaluate_held(0.1);
  EXPECT_EQ(relay.output("y"), 0);
  relay.crossings();
  EXPECT_GT(relay.crossing("threshold"), 0);
  relay.evaluate(0.1);
  relay.crossings();
  EXPECT_LT(relay.crossing("threshold"), 0);
}

TEST(Relay, RefusesThresholdsInTheWrongOrder) {
  BlockUnderTest relay("Relay", R"({"switch_on": -1, "switch_off": 1})");
  EXPECT_NE(relay.problems().text().find("switch_off <= switch_on"), std::string::npos)
      << relay.problems().text();
}

}  // namespace loopwright::relay_test
