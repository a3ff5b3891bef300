#include <gmock/gmock.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::rate_limiter_test {
namespace {

TEST(RateLimiter, MovesNoFasterThanItsLimits) {
  BlockUnderTest block("RateLimiter", R"({"rising": 2, "falling": 4, "initial": 1})", 0.25);
  for (double expected : {1.5, 2.0, 2.5, 3.0, 3.0}) EXPECT_EQ(block.sample("u", 3, "y"), expected);
  for (double expected : {2.0, 1.0, 0.0, -0.5, -0.5}) EXPECT_EQ(block.sample("u", -0.5, "y"), expected);
}

TEST(RateLimiter, PassesSlowSignalsUnchanged) {
  BlockUnderTest block("RateLimiter", R"({"rising": 1, "falling": 1})", 0.01);
  for (int k = 0; k < 100; ++k)
    EXPECT_EQ(block.sample("u", 0.9 * std::sin(0.01 * k), "y"), 0.9 * std::sin(0.01 * k));
}

TEST(RateLimiter, RefusesNegativeSpeeds) {
  EXPECT_THAT(BlockUnderTest("RateLimiter", R"({"rising": 1, "falling": -1})", 0.01).problems().text(),
              testing::HasSubstr("/falling"));
}

}  // namespace
}  // namespace loopwright::rate_limiter_test
