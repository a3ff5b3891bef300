#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::gain_test {

TEST(Gain, MultipliesItsSignal) {
  BlockUnderTest gain("Gain", R"({"gain": -2.5})");
  gain.input("u") = 4;
  gain.evaluate();
  EXPECT_EQ(gain.output("y"), -10);
}

TEST(Gain, FollowsATunedFactor) {
  BlockUnderTest gain("Gain", R"({"gain": 1})");
  gain.input("u") = 3;
  gain.tune("gain", 7);
  gain.evaluate();
  EXPECT_EQ(gain.output("y"), 21);
}

TEST(Gain, AsksForItsFactor) {
  BlockUnderTest gain("Gain", R"({"gian": 1})");
  const std::string text = gain.problems().text();
  EXPECT_NE(text.find("the parameter \"gain\" is missing"), std::string::npos) << text;
  EXPECT_NE(text.find("did you mean \"gain\"?"), std::string::npos) << text;
}

}  // namespace loopwright::gain_test
