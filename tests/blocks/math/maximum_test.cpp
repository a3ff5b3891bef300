#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::maximum_test {

TEST(Maximum, GivesTheGreatestOfItsTerms) {
  BlockUnderTest block("Maximum");
  block.inputs("terms") = {3, -2, 7, 0};
  block.evaluate();
  EXPECT_EQ(block.output("greatest"), 7);
}

TEST(Maximum, OfOneTermIsThatTerm) {
  BlockUnderTest block("Maximum");
  block.inputs("terms") = {3};
  block.evaluate();
  EXPECT_EQ(block.output("greatest"), 3);
  block.crossings();
  EXPECT_GT(block.crossing("change"), 0);
}

TEST(Maximum, LetsNoNumberHideWhatIsNone) {
  for (int place = 0; place < 3; ++place) {
    BlockUnderTest block("Maximum");
    block.inputs("terms") = {3, -2, 7};
    block.inputs("terms")[size_t(place)] = std::nan("");
    block.evaluate();
    EXPECT_TRUE(std::isnan(block.output("greatest"))) << place;
  }
}

TEST(Maximum, ACrossingTellsWhenAnotherTermTakesOver) {
  BlockUnderTest block("Maximum");
  block.inputs("terms") = {1, 2, 3};
  block.evaluate();
  block.crossings();
  EXPECT_EQ(block.crossing("change"), 1);
  block.inputs("terms") = {1, 3.5, 3};
  block.crossings();
  EXPECT_EQ(block.crossing("change"), -0.5);
}

}  // namespace loopwright::maximum_test
