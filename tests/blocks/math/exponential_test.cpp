#include <gmock/gmock.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::exponential_test {

TEST(Exponential, IsThatOfTheCLibrary) {
  BlockUnderTest block("Exponential");
  for (double u = -700; u < 700; u += 0.37) {
    block.input("u") = u;
    block.evaluate();
    EXPECT_NEAR(block.output("y") / double(expl(u)), 1, 5e-16) << u;
  }
  EXPECT_EQ(block.fault(), "");
  block.input("u") = 710;
  block.evaluate();
  EXPECT_EQ(block.fault(), "the exponential is too large for a number");
}

}  // namespace loopwright::exponential_test
