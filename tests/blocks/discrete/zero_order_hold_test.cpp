#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::zero_order_hold_test {
namespace {

TEST(ZeroOrderHold, TakesThePresentSample) {
  BlockUnderTest block("ZeroOrderHold", "{}", 0.01);
  for (double u : {1.0, -2.0, 7.5}) EXPECT_EQ(block.sample("u", u, "y"), u);
}

TEST(ZeroOrderHold, MustBeGivenASampleTime) {
  EXPECT_TRUE(BlockUnderTest("ZeroOrderHold", "{}", 0.01).info().is_sampled);
}

}  // namespace
}  // namespace loopwright::zero_order_hold_test
