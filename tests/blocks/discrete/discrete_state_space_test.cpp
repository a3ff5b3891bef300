#include <gmock/gmock.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::discrete_state_space_test {
namespace {

TEST(DiscreteStateSpace, UpdatesAllStatesFromTheOldOnes) {
  BlockUnderTest block("DiscreteStateSpace",
                       R"({"A": [[0, 1], [1, 0]], "B": [[0], [0]], "C": [[1, 0], [0, 1]], "D": [[0], [0]],
                                                 "initial": [3, 5]})",
                       0.1);
  for (int k = 0; k < 4; ++k) {  // the states are exchanged, which an update in place would corrupt
    block.evaluate();
    EXPECT_THAT(block.outputs("y"), k % 2 ? testing::ElementsAre(5, 3) : testing::ElementsAre(3, 5));
    block.update();
  }
}

TEST(DiscreteStateSpace, FollowsItsRecursion) {
  BlockUnderTest block("DiscreteStateSpace",
                       R"({"A": [[0.9, 0.2], [-0.3, 0.7]], "B": [[1, 0], [0.5, 2]], "C": [[1, -1]],
                                                 "D": [[0.1, 0]]})",
                       0.1);
  double x = 0, v = 0;
  for (int k = 0; k < 60; ++k) {
    const double a = std::sin(k), b = std::cos(3.0 * k);
    block.inputs("u") = {a, b};
    block.evaluate();
    EXPECT_NEAR(block.outputs("y")[0], x - v + 0.1 * a, 1e-13);
    block.update();
    const double next = 0.9 * x + 0.2 * v + a;
    v = -0.3 * x + 0.7 * v + 0.5 * a + 2 * b, x = next;
  }
}

TEST(DiscreteStateSpace, SaysWhichMatrixDoesNotFit) {
  EXPECT_THAT(
      BlockUnderTest("DiscreteStateSpace", R"({"A": [[1]], "B": [[1]], "C": [[1]], "D": [[0], [1]]})", 0.1)
          .problems()
          .text(),
      testing::HasSubstr("1 rows of 1 numbers"));
}

}  // namespace
}  // namespace loopwright::discrete_state_space_test
