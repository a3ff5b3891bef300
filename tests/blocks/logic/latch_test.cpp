#include <gmock/gmock.h>
#include <random>
#include "tests/blocks/block_under_test.h"

namespace loopwright::latch_test {
namespace {

TEST(Latch, IsTheFlipFlopOfItsPriority) {
  for (const bool set_wins : {false, true}) {
    std::mt19937_64 random(2);
    BlockUnderTest latch("Latch", set_wins ? R"({"priority": "set"})" : "{}");
    bool stored = false;
    for (int k = 0; k < 1000; ++k) {
      const bool set = random() % 3 == 0, reset = random() % 3 == 0;
      latch.input("set") = set, latch.input("reset") = reset;
      latch.evaluate(k);
      if (set && reset)
        stored = set_wins;
      else if (set || reset)
        stored = set;
      EXPECT_EQ(latch.output("y"), stored) << k;
    }
  }
}

TEST(Latch, StartsAsWritten) {
  BlockUnderTest off("Latch"), on("Latch", R"({"starts_on": true})");
  off.evaluate(), on.evaluate();
  EXPECT_EQ(off.output("y"), 0);
  EXPECT_EQ(on.output("y"), 1);
}

TEST(Latch, HoldsInsideASolverStepUntilACrossing) {
  BlockUnderTest latch("Latch");
  latch.evaluate();
  latch.input("set") = 1;
  latch.evaluate_held(0.1);
  EXPECT_EQ(latch.output("y"), 0);
  latch.crossings();
  EXPECT_GT(latch.crossing("set"), 0);
  EXPECT_LT(latch.crossing("reset"), 0);
}

TEST(Latch, StopsAtNaN) {
  BlockUnderTest latch("Latch");
  latch.input("reset") = std::nan("");
  latch.evaluate();
  EXPECT_THAT(std::string(latch.fault()), testing::HasSubstr("NaN"));
}

}  // namespace
}  // namespace loopwright::latch_test
