#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::minimum_test {

TEST(Minimum, GivesTheLeastOfItsTerms) {
  BlockUnderTest block("Minimum");
  block.inputs("terms") = {3, -2, 7, 0};
  block.evaluate();
  EXPECT_EQ(block.output("least"), -2);
}

TEST(Minimum, OfOneTermIsThatTerm) {
  BlockUnderTest block("Minimum");
  block.inputs("terms") = {3};
  block.evaluate();
  EXPECT_EQ(block.output("least"), 3);
  block.crossings();
  EXPECT_GT(block.crossing("change"), 0);
}

TEST(Minimum, LetsNoNumberHideWhatIsNone) {
  for (int place = 0; place < 3; ++place) {
    BlockUnderTest block("Minimum");
    block.inputs("terms") = {3, -2, 7};
    block.inputs("terms")[size_t(place)] = std::nan("");
    block.evaluate();
    EXPECT_TRUE(std::isnan(block.output("least"))) << place;
  }
}

TEST(Minimum, ACrossingTellsWhenAnotherTermTakesOver) {
  BlockUnderTest block("Minimum");
  block.inputs("terms") = {1, 2, 3};
  block.evaluate();
  block.crossings();
  EXPECT_EQ(block.crossing("change"), 1);
  block.inputs("terms") = {1, 0.5, 3};
  block.crossings();
  EXPECT_EQ(block.crossing("change"), -0.5);
}

}  // namespace loopwright::minimum_test
