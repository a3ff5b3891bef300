#include <gmock/gmock.h>
#include <random>
#include "tests/blocks/block_under_test.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::counter_test {
namespace {

TEST(Counter, CountsRisesUpAndDown) {
  std::mt19937_64 random(3);
  BlockUnderTest counter("Counter", R"({"initial": 7})");
  int count = 7;
  bool last_up = true, last_down = true;  // a first value is no edge
  for (int k = 0; k < 2000; ++k) {
    const bool up = random() % 2, down = random() % 2, reset = random() % 50 == 0;
    counter.input("up") = up, counter.input("down") = down, counter.input("reset") = reset;
    counter.evaluate(k);
    count += (up && !last_up) - (down && !last_down);
    if (reset) count = 7;
    last_up = up, last_down = down;
    ASSERT_EQ(counter.output("count"), count) << k;
    counter.evaluate(k);  // once more at the same instant, as after a jump
    ASSERT_EQ(counter.output("count"), count) << k;
  }
}

void pulse(BlockUnderTest& counter, const char* input) {
  for (const double u : {0.0, 1.0}) {
    counter.input(input) = u;
    counter.evaluate();
  }
}

TEST(Counter, StaysAtItsLimitsOrWraps) {
  BlockUnderTest stays("Counter", R"({"low": -1, "high": 2})"),
      wraps("Counter", R"({"low": -1, "high": 2, "wraps": true})");
  const double staying[] = {1, 2, 2, 2, 2}, wrapping[] = {1, 2, -1, 0, 1};
  for (int i = 0; i < 5; ++i) {
    pulse(stays, "up"), pulse(wraps, "up");
    EXPECT_EQ(stays.output("count"), staying[i]);
    EXPECT_EQ(wraps.output("count"), wrapping[i]);
  }
  for (int i = 0; i < 3; ++i) pulse(wraps, "down");
  EXPECT_EQ(wraps.output("count"), 2);
}

TEST(Counter, RefusesLimitsThatCannotBe) {
  const auto text = [](const char* settings) {
    return BlockUnderTest("Counter", settings).problems().text();
  };
  EXPECT_THAT(text(R"({"initial": 3, "high": 2})"), testing::HasSubstr("low <= initial <= high"));
  EXPECT_THAT(text(R"({"high": 2.5})"), testing::HasSubstr("whole number"));
  EXPECT_THAT(text(R"({"high": 2, "wraps": true})"), testing::HasSubstr("both limits"));
}

TEST(Counter, CountsEveryPassageOfAnOscillator) {
  // x = sin(20 t) rises through 0.9 once in each period: 31 times in 10 s, whatever the steps of the solver.
  const RunResult result = run_of(diagram(R"("x": {"type": "Integrator", "in": {"u": "v.y"}},
      "v": {"type": "Integrator", "initial": 20, "in": {"u": "a.y"}},
      "a": {"type": "Gain", "gain": -400, "in": {"u": "x.y"}},
      "level": {"type": "Constant", "value": 0.9},
      "high": {"type": "Comparison", "operator": ">", "in": {"a": "x.y", "b": "level.y"}},
      "passages": {"type": "Counter", "in": {"up": "high.y"}})",
                                          R"("method": "dopri5", "stop": 10, "record_step": 0.1)"));
  int expected = 0;
  for (int k = 0; (std::asin(0.9) + 2 * pi * k) / 20 < 10; ++k) ++expected;
  EXPECT_EQ(signal(result, "passages.count").back(), expected);
}

}  // namespace
}  // namespace loopwright::counter_test
