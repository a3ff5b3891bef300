#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::sign_test {

TEST(Sign, GivesMinusOneZeroOrOne) {
  BlockUnderTest sign("Sign");
  const double u[] = {-1e-9, 0, 7}, expected[] = {-1, 0, 1};
  for (int i = 0; i < 3; ++i) {
    sign.input("u") = u[i];
    sign.evaluate();
    EXPECT_EQ(sign.output("y"), expected[i]);
  }
}

TEST(Sign, KeepsItsValueInsideASolverStep) {
  BlockUnderTest sign("Sign");
  sign.input("u") = 1;
  sign.evaluate();
  sign.input("u") = -1;
  sign.evaluate_held(0.1);
  EXPECT_EQ(sign.output("y"), 1);
}

TEST(Sign, LeavingZeroChangesTheSignOfACrossing) {
  BlockUnderTest sign("Sign");
  const auto crossings = [&](double u) {
    sign.input("u") = u;
    sign.crossings();
    return std::pair(sign.crossing("above") > 0, sign.crossing("below") < 0);
  };
  EXPECT_EQ(crossings(0), std::pair(false, false));
  EXPECT_EQ(crossings(1e-250), std::pair(true, false));
  EXPECT_EQ(crossings(-1e-250), std::pair(false, true));
}

}  // namespace loopwright::sign_test
