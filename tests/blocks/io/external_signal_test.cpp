#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::external_signal_test {

TEST(ExternalSignal, FollowsTheParabolaThatItIsSet) {
  BlockUnderTest block("ExternalSignal", R"({"value": 3, "slope": -2, "bend": 0.5, "since": 1})");
  for (auto [time, y] : {std::pair{0.0, 5.5}, {1.0, 3.0}, {2.0, 1.5}, {5.0, 3.0}}) {
    block.evaluate(time);
    EXPECT_DOUBLE_EQ(block.output("y"), y) << time;
  }
}

TEST(ExternalSignal, IsZeroUntilItIsSet) {
  BlockUnderTest block("ExternalSignal");
  block.evaluate(3);
  EXPECT_EQ(block.output("y"), 0);
  block.tune("value", 4);
  block.evaluate(3);
  EXPECT_EQ(block.output("y"), 4);
}

}  // namespace loopwright::external_signal_test
