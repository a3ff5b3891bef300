#include <gmock/gmock.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::delay_test {
namespace {

TEST(Delay, ShowsTheSignalThatManySamplesAgo) {
  for (int n : {1, 2, 5, 64}) {
    BlockUnderTest block("Delay", R"({"initial": -1, "samples": )" + std::to_string(n) + "}", 0.01);
    for (int k = 0; k < 200; ++k) EXPECT_EQ(block.sample("u", k * k, "y"), k < n ? -1 : (k - n) * (k - n));
  }
}

TEST(Delay, NeedsNoPresentInput) {
  EXPECT_EQ(BlockUnderTest("Delay", R"({"samples": 3})", 0.01).info().outputs[0].fed_by, 0u);
}

TEST(Delay, RefusesNoSamples) {
  EXPECT_THAT(BlockUnderTest("Delay", R"({"samples": 0})", 0.01).problems().text(),
              testing::HasSubstr("at least 1"));
}

}  // namespace
}  // namespace loopwright::delay_test
