#include <gmock/gmock.h>
#include <random>
#include "tests/blocks/block_under_test.h"
#include "tests/engine/written_diagram.h"

namespace loopwright::timer_test {
namespace {

/// Samples of 1 ms and a duration of `wait` ms, counted in whole samples: the timers of IEC 61131-3 as a
/// programmable controller runs them.
struct CountedTimer {
  std::string kind;
  int wait;
  int since = -1;  // sample of the start; -1: idle
  bool last = false, has_last = false;
  bool next(int k, bool u) {
    const bool rises = has_last && u && !last, falls = has_last && !u && last;
    last = u, has_last = true;
    if (kind == "on_delay") {
      since = !u ? -1 : since < 0 ? k : since;
      return u && k - since >= wait;
    }
    if (kind == "off_delay") {
      if (u) since = -1;
      if (falls) since = k;
      if (since >= 0 && k - since >= wait) since = -1;
      return u || since >= 0;
    }
    if (since < 0 && rises) since = k;
    if (since >= 0 && k - since >= wait) since = -1;
    return since >= 0;
  }
};

TEST(Timer, AgreesWithCountedSamples) {
  for (const std::string kind : {"on_delay", "off_delay", "one_shot"})
    for (const int wait : {0, 1, 3, 7, 10, 100}) {
      SCOPED_TRACE(kind + " of " + std::to_string(wait) + " ms");
      std::mt19937_64 random(4);
      BlockUnderTest timer("Timer", fmt::format(R"({{"kind": "{}", "duration": {}}})", kind, wait * 1e-3),
                           1e-3);
      CountedTimer reference{kind, wait};
      bool u = false;
      for (int k = 0; k < 20000; ++k) {
        if (random() % 8 == 0) u = !u;
        timer.input("u") = u;
        timer.evaluate(k / 1000.0, k);  // the double nearest to k ms, as in a run
        ASSERT_EQ(timer.output("y"), reference.next(k, u)) << "at sample " << k;
        timer.evaluate(k / 1000.0, k);
        ASSERT_EQ(timer.output("elapsed") > 0, reference.since >= 0 && reference.since < k && wait > 0)
            << "at sample " << k;
      }
    }
}

TEST(Timer, EndsAtTheExactInstantInAVariableStepRun) {
  // sin t is above one half from π/6 to 5π/6. What is integrated is the time for which y is 1.
  const auto time_of = [](const char* kind) {
    const RunResult result = run_of(diagram(
        fmt::format(
            R"("wave": {{"type": "Sine", "amplitude": 1, "frequency": {{"value": 1, "unit": "rad/s"}}}},
          "timer": {{"type": "Timer", "kind": "{}", "duration": 0.7, "in": {{"u": "wave.y"}}}},
          "rate": {{"type": "Gain", "gain": {{"value": 1, "unit": "1/s"}}, "in": {{"u": "timer.y"}}}},
          "time": {{"type": "Integrator", "in": {{"u": "rate.y"}}}})",
            kind),
        R"("method": "dopri5", "stop": 6, "relative_tolerance": 1e-9)"));
    return signal(result, "time.y").back();
  };
  EXPECT_NEAR(time_of("on_delay"), 2 * pi / 3 - 0.7, 1e-9);
  EXPECT_NEAR(time_of("off_delay"), 2 * pi / 3 + 0.7, 1e-9);
  EXPECT_NEAR(time_of("one_shot"), 0.7, 1e-9);
}

TEST(Timer, AnOnDelayBeginsAtTheStartAndAOneShotDoesNot) {
  for (const auto& [kind, y] : {std::pair("on_delay", 1.0), {"one_shot", 0.0}, {"off_delay", 1.0}}) {
    BlockUnderTest timer("Timer", fmt::format(R"({{"kind": "{}", "duration": 1}})", kind));
    timer.input("u") = 1;
    timer.evaluate(0);
    timer.evaluate(1);
    EXPECT_EQ(timer.output("y"), y) << kind;
  }
}

TEST(Timer, TellsHowMuchHasPassed) {
  BlockUnderTest timer("Timer", R"({"kind": "on_delay", "duration": 2})");
  timer.input("u") = 1;
  for (const auto& [time, elapsed] : {std::pair(10.0, 0.0), {10.5, 0.5}, {12.0, 2.0}, {13.0, 2.0}}) {
    timer.evaluate(time);
    EXPECT_EQ(timer.output("elapsed"), elapsed) << time;
  }
  timer.input("u") = 0;
  timer.evaluate(14);
  EXPECT_EQ(timer.output("elapsed"), 0);
}

TEST(Timer, StopsAtNaN) {
  BlockUnderTest timer("Timer", R"({"kind": "on_delay", "duration": 2})");
  timer.input("u") = std::nan("");
  timer.evaluate();
  EXPECT_THAT(std::string(timer.fault()), testing::HasSubstr("NaN"));
}

}  // namespace
}  // namespace loopwright::timer_test
