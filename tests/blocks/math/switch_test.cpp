#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::switch_test {

TEST(Switch, ChoosesTheFirstSignalAboveTheThreshold) {
  BlockUnderTest choice("Switch", R"({"threshold": 2})");
  choice.input("first") = 10;
  choice.input("second") = 20;
  const double control[] = {1, 2, 2.1}, expected[] = {20, 20, 10};
  for (int i = 0; i < 3; ++i) {
    choice.input("control") = control[i];
    choice.evaluate();
    EXPECT_EQ(choice.output("y"), expected[i]);
  }
}

TEST(Switch, KeepsItsChoiceInsideASolverStepAndTellsWhenItChanges) {
  BlockUnderTest choice("Switch");
  choice.input("first") = 10;
  choice.input("control") = 1;
  choice.evaluate();
  choice.crossings();
  EXPECT_GT(choice.crossing("control"), 0);
  choice.input("control") = 0.5;
  choice.evaluate_held(0.1);
  EXPECT_EQ(choice.output("y"), 10);
  choice.crossings();
  EXPECT_LT(choice.crossing("control"), 0);
}

}  // namespace loopwright::switch_test
