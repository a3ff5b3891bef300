#include <gmock/gmock.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::state_space_test {
namespace {

constexpr auto oscillator = R"({"A": [[0, 1], [-4, 0]], "B": [[0, 0], [1, 2]], "C": [[1, 0], [0, 1], [1, 1]],
                                "D": [[0, 0], [0, 0], [10, 20]], "initial": [0.5, -1]})";

TEST(StateSpace, FollowsTheClosedFormOfAnOscillator) {
  BlockUnderTest block("StateSpace", oscillator);
  block.inputs("u") = {3, 0.5};
  block.advance(1.3, 2000);
  block.evaluate();
  const double drive = 4, c = std::cos(2.6), s = std::sin(2.6);  // x'' + 4 x = 3 + 2 · 0.5
  const double x = drive / 4 + (0.5 - drive / 4) * c - 0.5 * s, v = -2 * (0.5 - drive / 4) * s - c;
  EXPECT_THAT(block.outputs("y"),
              testing::ElementsAre(testing::DoubleNear(x, 1e-11), testing::DoubleNear(v, 1e-11),
                                   testing::DoubleNear(x + v + 40, 1e-11)));
}

TEST(StateSpace, TheStrictlyProperOneGivesTheSameWithoutD) {
  BlockUnderTest block("StrictlyProperStateSpace", R"({"A": [[-2]], "B": [[3]], "C": [[5], [7]]})");
  EXPECT_EQ(block.info().outputs[0].fed_by, 0u);
  block.inputs("u") = {2};
  block.advance(0.4, 1000);
  block.evaluate();
  const double x = 3 * (1 - std::exp(-0.8));
  EXPECT_THAT(block.outputs("y"),
              testing::ElementsAre(testing::DoubleNear(5 * x, 1e-12), testing::DoubleNear(7 * x, 1e-12)));
}

TEST(StateSpace, EveryElementIsTunable) {
  BlockUnderTest block("StateSpace", oscillator);
  block.tune("D.2.1", 100);
  block.inputs("u") = {0, 1};
  block.evaluate();
  EXPECT_EQ(block.outputs("y")[2], 99.5);
}

TEST(StateSpace, SaysWhichMatrixDoesNotFit) {
  const auto text = [](const char* settings) {
    return BlockUnderTest("StateSpace", settings).problems().text();
  };
  EXPECT_THAT(text(R"({"A": [[1, 2], [3]], "B": [[1], [1]], "C": [[1, 0]], "D": [[0]]})"),
              testing::AllOf(testing::HasSubstr("/A"), testing::HasSubstr("2 rows of 2 numbers"),
                             testing::HasSubstr("row 1 of 1")));
  EXPECT_THAT(text(R"({"A": [[1]], "B": [[1], [2]], "C": [[1]], "D": [[0]]})"), testing::HasSubstr("/B"));
  EXPECT_THAT(text(R"({"A": [[1]], "B": [[1]], "C": [[1, 2]], "D": [[0]]})"), testing::HasSubstr("/C"));
  EXPECT_THAT(text(R"({"A": [[1]], "B": [[1]], "C": [[1]], "D": [[0, 0]]})"), testing::HasSubstr("/D"));
  EXPECT_THAT(text(R"({"A": [[1]], "B": [[1]], "C": [[1]], "D": [[0]], "initial": [1, 2]})"),
              testing::HasSubstr("/initial"));
  EXPECT_THAT(BlockUnderTest("StateSpace", R"({"A": [], "B": [[]], "C": [], "D": []})").problems().list(),
              testing::SizeIs(3));
}

}  // namespace
}  // namespace loopwright::state_space_test
