#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

using namespace loopwright;

TEST(ConstantForce, IsAlwaysThere) {
  BlockUnderTest force("ConstantForce", R"({"level": -3.1648})");
  for (double time : {0.0, 5.0}) {
    force.evaluate(time);
    EXPECT_EQ(force.output("force"), -3.1648);
  }
}
