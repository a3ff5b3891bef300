#include <gmock/gmock.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::selector_test {

TEST(Selector, TakesElementsInItsOrder) {
  BlockUnderTest selector("Selector", R"({"indices": [2, 0, 2]})");
  selector.inputs("u") = {1, 2, 3};
  selector.evaluate();
  EXPECT_THAT(selector.outputs("y"), testing::ElementsAre(3, 1, 3));
  EXPECT_EQ(selector.fault(), "");
}

TEST(Selector, StopsAtAnElementThatDoesNotExist) {
  BlockUnderTest selector("Selector", R"({"indices": [0, 3]})");
  selector.inputs("u") = {1, 2, 3};
  selector.evaluate();
  EXPECT_EQ(selector.fault(), "the vector has no element of this index");
}

TEST(Selector, RefusesAnEmptyChoice) {
  EXPECT_THAT(BlockUnderTest("Selector", R"({"indices": []})").problems().text(),
              testing::HasSubstr("no element is selected"));
}

}  // namespace loopwright::selector_test
