#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::pulse_train_test {

TEST(PulseTrain, IsHighForTheWidthOfEachPeriod) {
  BlockUnderTest wave("PulseTrain", R"({"period": 1, "width": 0.25, "start": 0.5, "low": -1, "high": 2})");
  const double time[] = {0, 0.49, 0.5, 0.7499, 0.75, 1.4, 1.5, 10.6, 10.8};
  const double expected[] = {-1, -1, 2, 2, -1, -1, 2, 2, -1};
  for (int i = 0; i < 9; ++i) {
    wave.evaluate(time[i]);
    EXPECT_EQ(wave.output("y"), expected[i]) << time[i];
  }
}

/// A solver that steps from stop to stop must see each edge, whatever the rounding of period and start.
TEST(PulseTrain, ChangesAtEveryStopThatItAnnounces) {
  for (const char* settings :
       {R"({"period": 0.1, "width": 0.03, "start": 0.7})", R"({"period": 0.007, "width": 0.001})"}) {
    BlockUnderTest wave("PulseTrain", settings);
    double t = wave.next_stop(-1);
    for (int edge = 0; edge < 20000; ++edge) {
      wave.evaluate(t);
      ASSERT_EQ(wave.output("y"), edge % 2 ? 0 : 1) << settings << " edge " << edge << " at " << t;
      ASSERT_GT(wave.next_stop(t), t);
      t = wave.next_stop(t);
    }
  }
}

/// On a grid that resolves period, width and start every sample is correct, up to a billion samples.
TEST(PulseTrain, IsExactOnTicksHoweverManyHavePassed) {
  struct Case {
    const char* settings;
    int64_t start, period, width, rate;  // ticks, and ticks a second
  };
  for (const Case& c :
       {Case{R"({"period": 0.003, "width": 0.001})", 0, 3, 1, 1000},
        Case{R"({"period": 0.01, "width": 0.005})", 0, 10, 5, 1000},
        Case{R"({"period": 0.0007, "width": 0.0002, "start": 0.0003})", 3, 7, 2, 10000},
        Case{R"({"period": 0.00033333333333333333, "width": 0.00011111111111111111})", 0, 3, 1, 9000},
        Case{R"({"period": 0.3, "width": 0.1, "start": -0.1})", -1, 3, 1, 10}}) {
    BlockUnderTest wave("PulseTrain", c.settings);
    for (const int64_t from : {int64_t(0), int64_t(123'456'789), int64_t(999'990'000)})
      for (int64_t tick = from; tick < from + 10'000; ++tick) {
        wave.evaluate(double(tick) / double(c.rate), tick);
        const int64_t phase = ((tick - c.start) % c.period + c.period) % c.period;
        ASSERT_EQ(wave.output("y"), tick >= c.start && phase < c.width ? 1 : 0) << c.settings << " " << tick;
        const int64_t edge = tick + (phase < c.width ? c.width : c.period) - phase;
        if (tick >= c.start) {
          ASSERT_EQ(wave.next_stop(double(tick) / double(c.rate)), double(edge) / double(c.rate)) << tick;
        }
      }
  }
}

TEST(PulseTrain, IsExactAfterTuningToo) {
  BlockUnderTest wave("PulseTrain", R"({"period": 1, "width": 0.5})");
  wave.tune("period", 0.003);
  wave.tune("width", 0.001);
  for (int64_t tick = 0; tick < 30'000; ++tick) {
    wave.evaluate(double(tick) / 1000, tick);
    ASSERT_EQ(wave.output("y"), tick % 3 == 0) << tick;
  }
}

TEST(PulseTrain, RefusesPulsesLongerThanThePeriod) {
  BlockUnderTest wave("PulseTrain", R"({"period": 1, "width": 2})");
  EXPECT_NE(wave.problems().text().find("longer than the period"), std::string::npos)
      << wave.problems().text();
}

}  // namespace loopwright::pulse_train_test
