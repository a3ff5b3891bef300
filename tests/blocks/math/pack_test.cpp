#include <gtest/gtest.h>
#include <gmock/gmock.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::pack_test {

TEST(Pack, StringsItsElementsTogetherInOrder) {
  BlockUnderTest pack("Pack");
  pack.inputs("elements") = {3, 1, 2};
  pack.evaluate();
  EXPECT_THAT(pack.outputs("y"), testing::ElementsAre(3, 1, 2));
}

}  // namespace loopwright::pack_test
