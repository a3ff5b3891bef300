#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright {

TEST(PulseTrain, IsHighForTheWidthOfEachPeriod) {
  BlockUnderTest wave("PulseTrain", R"({"period": 1, "width": 0.25, "start": 0.5, "low": -1, "high": 2})");
  const double time[] = {0, 0.49, 0.5, 0.7499, 0.75, 1.4, 1.5, 10.6, 10.8};
  const double expected[] = {-1, -1, 2, 2, -1, -1, 2, 2, -1};
  for (int i = 0; i < 9; ++i) {
    wave.evaluate(time[i]);
    EXPECT_EQ(wave.output("y"), expected[i]) << time[i];
  }
}

/// Whoever steps from stop to stop must see each edge, whatever the rounding of period and start.
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

TEST(PulseTrain, RefusesPulsesLongerThanThePeriod) {
  BlockUnderTest wave("PulseTrain", R"({"period": 1, "width": 2})");
  EXPECT_NE(wave.problems().text().find("longer than the period"), std::string::npos)
      << wave.problems().text();
}

}  // namespace loopwright
