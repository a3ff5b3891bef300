#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::clock_test {

TEST(Clock, GivesTheTime) {
  BlockUnderTest clock("Clock");
  for (double t : {0.0, 0.125, 3600.0}) {
    clock.evaluate(t);
    EXPECT_EQ(clock.output("time"), t);
  }
}

}  // namespace loopwright::clock_test
