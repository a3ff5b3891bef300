#include <gmock/gmock.h>
#include <random>
#include "tests/blocks/block_under_test.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::sample_and_hold_test {
namespace {

TEST(SampleAndHold, HoldsTheValueAtItsEdges) {
  for (const std::string kind : {"rising", "falling", "either"}) {
    std::mt19937_64 random(5);
    BlockUnderTest block("SampleAndHold", R"({"initial": -5, "samples": ")" + kind + "\"}");
    double held = -5;
    bool last = false;
    for (int k = 0; k < 1000; ++k) {
      const bool trigger = random() % 2;
      const double u = double(random() % 100);
      block.input("u") = u, block.input("trigger") = trigger;
      block.evaluate(k);
      const bool rises = k > 0 && trigger && !last, falls = k > 0 && !trigger && last;
      if ((rises && kind != "falling") || (falls && kind != "rising")) held = u;
      last = trigger;
      ASSERT_EQ(block.output("y"), held) << kind << " at " << k;
    }
  }
}

TEST(SampleAndHold, FollowsWhileTrue) {
  BlockUnderTest block("SampleAndHold", R"({"initial": -5, "samples": "while_true"})");
  const double trigger[] = {0, 1, 1, 0, 0, 1}, expected[] = {-5, 1, 2, 3, 3, 5};
  for (int k = 0; k < 6; ++k) {
    block.input("u") = k, block.input("trigger") = trigger[k];
    block.evaluate(k);
    EXPECT_EQ(block.output("y"), expected[k]) << k;
  }
}

TEST(SampleAndHold, SamplesAtTheExactInstant) {
  // x = t² passes 2 at t = √2, where t is sampled.
  const RunResult result = run_of(diagram(R"("t": {"type": "Clock"}, "two": {"type": "Constant", "value": 2},
      "twice": {"type": "Gain", "gain": 2, "in": {"u": "t.time"}}, "x": {"type": "Integrator", "in": {"u": "twice.y"}},
      "passed": {"type": "Comparison", "operator": ">", "in": {"a": "x.y", "b": "two.y"}},
      "when": {"type": "SampleAndHold", "in": {"u": "t.time", "trigger": "passed.y"}})",
                                          R"("method": "dopri5", "stop": 3, "record_step": 1)"));
  EXPECT_NEAR(signal(result, "when.y").back(), std::sqrt(2.0), 1e-12);
}

TEST(SampleAndHold, SamplesBeforeAResetAtTheSameInstant) {
  // The integrator is reset where it is sampled: what is held is the value before.
  const RunResult result =
      run_of(diagram(R"("one": {"type": "Constant", "value": {"value": 1, "unit": "1/s"}},
      "tick": {"type": "PulseTrain", "period": 1, "width": 0.5, "start": 0.75},
      "x": {"type": "Integrator", "in": {"u": "one.y", "reset": "tick.y"}},
      "last": {"type": "SampleAndHold", "in": {"u": "x.y", "trigger": "tick.y"}})",
                     R"("method": "dopri5", "stop": 2, "record_step": 0.5)"));
  EXPECT_NEAR(signal(result, "last.y").back(), 1.0, 1e-12);
  EXPECT_NEAR(signal(result, "x.y").back(), 0.25, 1e-12);
}

TEST(SampleAndHold, StopsAtATriggerThatIsNaN) {
  BlockUnderTest block("SampleAndHold");
  block.input("trigger") = std::nan("");
  block.evaluate();
  EXPECT_THAT(std::string(block.fault()), testing::HasSubstr("NaN"));
}

}  // namespace
}  // namespace loopwright::sample_and_hold_test
