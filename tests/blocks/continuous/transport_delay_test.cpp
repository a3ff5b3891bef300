#include <gmock/gmock.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::transport_delay_test {
namespace {

/// Runs over given steps like a solver: outputs at the end of the step, then its acceptance.
template <class Signal> void run_to(BlockUnderTest& block, double time, Signal signal) {
  block.input("u") = signal(time);
  block.evaluate(time);
  block.accept();
}

TEST(TransportDelay, GivesTheInitialValueUntilTheSignalArrives) {
  BlockUnderTest block("TransportDelay", R"({"delay": 0.1, "initial": -3})");
  for (int i = 0; i < 10; ++i) {
    run_to(block, 0.01 * i, [](double) { return 8.0; });
    EXPECT_EQ(block.output("y"), -3);
  }
  run_to(block, 0.1, [](double) { return 8.0; });
  EXPECT_EQ(block.output("y"), 8);
  block.evaluate_held(0.105);
  EXPECT_EQ(block.output("y"), 8);
}

TEST(TransportDelay, TheFirstPieceHoldsInsideAStepThatEndsAtTheDelay) {
  BlockUnderTest block("TransportDelay", R"({"delay": 0.1})");
  run_to(block, 0.0, [](double) { return 8.0; });
  run_to(block, 0.05, [](double) { return 8.0; });
  block.evaluate_held(0.1);  // a trial value of the solver: nothing is decided yet
  EXPECT_EQ(block.output("y"), 0);
}

/// On a grid that resolves the delay, each value comes back bit for bit, even after a long time.
TEST(TransportDelay, GivesBackWhatItTookOnAGrid) {
  BlockUnderTest block("TransportDelay", R"({"delay": 0.007, "initial": -1})");
  const auto value = [](int64_t tick) { return double(tick % 13 * (tick % 5)) / 7; };
  for (const int64_t from : {int64_t(0), int64_t(1'000'000'000)}) {
    block.restart();
    for (int64_t tick = from; tick < from + 5000; ++tick) {
      block.input("u") = value(tick);
      block.evaluate(double(tick) / 1000, tick);
      block.accept();
      ASSERT_EQ(block.output("y"), tick < from + 7 ? -1 : value(tick - 7)) << tick;
    }
  }
}

TEST(TransportDelay, ReproducesStraightLinesExactly) {
  BlockUnderTest block("TransportDelay", R"({"delay": 0.25, "points": 10})");
  const auto line = [](double t) { return 3 * t - 1; };
  double t = 0;
  for (int i = 0; t < 3; ++i) {
    run_to(block, t, line);
    if (t >= 0.25) {
      EXPECT_NEAR(block.output("y"), line(t - 0.25), 1e-13) << t;
    }
    t += i % 3 ? 0.013 : 0.002;
  }
}

TEST(TransportDelay, ErrsLessThanTheSquareOfTheGapSays) {
  const double delay = 0.3, w = 5;
  for (int points : {20, 80}) {
    BlockUnderTest block("TransportDelay", R"({"delay": 0.3, "points": )" + std::to_string(points) + "}");
    const double gap = delay / points, bound = gap * gap / 8 * w * w;
    double worst = 0;
    for (int i = 0; i < 20000; ++i) {
      const double t = i * 1.7e-4;
      run_to(block, t, [&](double x) { return std::sin(w * x); });
      if (t >= delay) worst = std::max(worst, std::abs(block.output("y") - std::sin(w * (t - delay))));
    }
    EXPECT_LT(worst, bound);
    EXPECT_GT(worst, 0.3 * bound);  // thinned to the requested number of points
  }
}

TEST(TransportDelay, KeepsTheWholeDelayWhateverTheSteps) {
  BlockUnderTest block("TransportDelay", R"({"delay": 1, "points": 8})");
  const auto line = [](double t) { return t; };
  double t = 0;
  for (int i = 0; t < 20; ++i) {  // a tiny step before each long one stores the most points
    run_to(block, t, line);
    if (t >= 1) {
      ASSERT_NEAR(block.output("y"), t - 1, 1e-12) << t;
    }
    t += i % 2 ? 0.1249 : 1e-4;
  }
}

TEST(TransportDelay, StopsTheSolverOneDelayAheadAndFaultsIfItLeapsFurther) {
  BlockUnderTest block("TransportDelay", R"({"delay": 0.1})");
  EXPECT_EQ(block.next_stop(0), 0.1);
  EXPECT_EQ(block.next_stop(0.04), 0.1);
  EXPECT_DOUBLE_EQ(block.next_stop(0.1), 0.2);
  run_to(block, 0.0, [](double) { return 1.0; });
  run_to(block, 0.1, [](double) { return 1.0; });
  EXPECT_EQ(block.fault(), "");
  block.evaluate_held(0.2);
  EXPECT_EQ(block.fault(), "");
  block.evaluate_held(0.21);
  EXPECT_EQ(block.fault(), "the solver's step is longer than the delay");
}

TEST(TransportDelay, ShowsAJumpThatIsSeenFromBothSidesAsAJump) {
  BlockUnderTest block("TransportDelay", R"({"delay": 0.1, "points": 10})");
  for (int i = 0; i < 40; ++i) {
    const double t = 0.005 * i;
    run_to(block, t, [&](double) { return i <= 10 ? 1.0 : 5.0; });
    if (i == 10) run_to(block, t, [](double) { return 5.0; });
    if (i >= 20 && i != 30) {
      EXPECT_EQ(block.output("y"), i < 30 ? 1 : 5) << t;
    }
  }
  EXPECT_EQ(block.fault(), "");
}

TEST(TransportDelay, CountsFromTheStartOfTheRunWhereverThatIs) {
  BlockUnderTest block("TransportDelay", R"({"delay": 0.25, "initial": -1})");
  for (int i = 0; i < 8; ++i) {
    const double t = 2 + 0.125 * i;
    run_to(block, t, [](double x) { return x; });
    EXPECT_EQ(block.output("y"), i < 2 ? -1 : t - 0.25);
    block.crossings();
    EXPECT_EQ(block.crossing("arrival"), i < 2 ? 0.125 * i - 0.25 : 1);
  }
}

TEST(TransportDelay, FaultsBeforeItForgetsWhatItStillNeeds) {
  BlockUnderTest block("TransportDelay", R"({"delay": 1, "points": 2})");
  for (int i = 0; i < 100 && block.fault().empty(); ++i) {
    run_to(block, 0.01 * i, [](double) { return 0.0; });
    run_to(block, 0.01 * i, [](double) { return 1.0; });
  }
  EXPECT_THAT(std::string(block.fault()), testing::HasSubstr("more points"));
}

TEST(TransportDelay, NeedsNoPresentInput) {
  BlockUnderTest block("TransportDelay", R"({"delay": 0.1})");
  EXPECT_EQ(block.info().outputs[0].fed_by, 0u);
  EXPECT_THAT(BlockUnderTest("TransportDelay", R"({"delay": 0})").problems().text(),
              testing::HasSubstr("above 0"));
}

}  // namespace
}  // namespace loopwright::transport_delay_test
