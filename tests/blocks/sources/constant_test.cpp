#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::constant_test {

TEST(Constant, GivesItsNumberAtAnyTime) {
  BlockUnderTest constant("Constant", R"({"value": -2.5})");
  for (double t : {0.0, 1.0, 1e6}) {
    constant.evaluate(t);
    EXPECT_EQ(constant.output("y"), -2.5);
  }
}

}  // namespace loopwright::constant_test
