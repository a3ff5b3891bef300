#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::constant_force_test {

TEST(ConstantForce, IsAlwaysThere) {
  BlockUnderTest force("ConstantForce", R"({"level": -3.1648})");
  for (double time : {0.0, 5.0}) {
    force.evaluate(time);
    EXPECT_EQ(force.output("force"), -3.1648);
  }
}

}  // namespace loopwright::constant_force_test
