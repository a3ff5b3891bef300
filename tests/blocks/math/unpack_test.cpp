#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::unpack_test {

TEST(Unpack, TakesTheElementOfItsIndex) {
  BlockUnderTest unpack("Unpack", R"({"index": 2})");
  unpack.inputs("u") = {10, 11, 12, 13};
  unpack.evaluate();
  EXPECT_EQ(unpack.output("y"), 12);
  EXPECT_EQ(unpack.fault(), "");
}

TEST(Unpack, StopsTheRunWhenTheVectorIsTooShort) {
  BlockUnderTest unpack("Unpack", R"({"index": 2})");
  unpack.inputs("u") = {10, 11};
  unpack.evaluate();
  EXPECT_EQ(unpack.fault(), "the vector has no element of this index");
}

TEST(Unpack, RefusesANegativeIndex) {
  EXPECT_TRUE(BlockUnderTest("Unpack", R"({"index": -1})").problems().has_errors());
}

}  // namespace loopwright::unpack_test
