#include <gmock/gmock.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::multiport_switch_test {
namespace {

TEST(MultiportSwitch, ChoosesByNumber) {
  BlockUnderTest choice("MultiportSwitch");
  choice.inputs("choices") = {10, 20, 30};
  for (const auto& [index, y] :
       {std::pair(0.0, 10.0), {1.0, 20.0}, {2.0, 30.0}, {1.4, 20.0}, {1.6, 30.0}, {-0.3, 10.0}}) {
    choice.input("index") = index;
    choice.evaluate();
    EXPECT_EQ(choice.output("y"), y) << index;
    choice.crossings();
    EXPECT_TRUE(choice.crossing("lower") > 0 && choice.crossing("upper") < 0) << index;
  }
  EXPECT_EQ(choice.fault(), "");
}

TEST(MultiportSwitch, StopsAtAChoiceThatDoesNotExist) {
  for (const double index : {3.0, -1.0, 1e300, std::nan("")}) {
    BlockUnderTest choice("MultiportSwitch");
    choice.inputs("choices") = {10, 20, 30};
    choice.input("index") = index;
    choice.evaluate();
    EXPECT_EQ(choice.fault(), "the index names no choice") << index;
  }
}

TEST(MultiportSwitch, KeepsItsChoiceInsideASolverStep) {
  BlockUnderTest choice("MultiportSwitch");
  choice.inputs("choices") = {10, 20};
  choice.evaluate();
  choice.input("index") = 0.7;
  choice.evaluate_held(0.1);
  EXPECT_EQ(choice.output("y"), 10);
  choice.crossings();
  EXPECT_GT(choice.crossing("upper"), 0);
}

}  // namespace
}  // namespace loopwright::multiport_switch_test
