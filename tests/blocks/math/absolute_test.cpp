#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::absolute_test {

TEST(Absolute, GivesTheSize) {
  BlockUnderTest absolute("Absolute");
  const double u[] = {-2.5, 0, 3}, expected[] = {2.5, 0, 3};
  for (int i = 0; i < 3; ++i) {
    absolute.input("u") = u[i];
    absolute.evaluate();
    EXPECT_EQ(absolute.output("y"), expected[i]);
  }
}

TEST(Absolute, ItsKinkIsACrossing) {
  BlockUnderTest absolute("Absolute");
  absolute.input("u") = -1e-9;
  absolute.crossings();
  EXPECT_LT(absolute.crossing("sign"), 0);
  absolute.input("u") = 1e-9;
  absolute.crossings();
  EXPECT_GT(absolute.crossing("sign"), 0);
}

}  // namespace loopwright::absolute_test
