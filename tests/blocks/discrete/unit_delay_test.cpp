#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::unit_delay_test {
namespace {

TEST(UnitDelay, ShowsTheSampleBefore) {
  BlockUnderTest block("UnitDelay", R"({"initial": 4})", 0.01);
  double expected = 4;
  for (double u : {1.0, -2.0, 7.5, 0.0}) {
    EXPECT_EQ(block.sample("u", u, "y"), expected);
    expected = u;
  }
}

TEST(UnitDelay, NeedsNoPresentInputAndASampleTime) {
  BlockUnderTest block("UnitDelay", "{}", 0.01);
  EXPECT_EQ(block.info().outputs[0].fed_by, 0u);
  EXPECT_TRUE(block.info().is_sampled);
}

TEST(UnitDelay, StartsAnewWithItsInitialValue) {
  BlockUnderTest block("UnitDelay", R"({"initial": 4})", 0.01);
  block.sample("u", 9, "y");
  block.restart();
  EXPECT_EQ(block.sample("u", 9, "y"), 4);
}

}  // namespace
}  // namespace loopwright::unit_delay_test
