#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::ramp_test {

TEST(Ramp, RisesBetweenItsTwoTimes) {
  BlockUnderTest ramp("Ramp", R"({"slope": -4, "start": 1, "stop": 3, "initial": 10})");
  const double time[] = {0, 1, 1.5, 2.75, 3, 50}, expected[] = {10, 10, 8, 3, 2, 2};
  for (int i = 0; i < 6; ++i) {
    ramp.evaluate(time[i]);
    EXPECT_DOUBLE_EQ(ramp.output("y"), expected[i]) << time[i];
  }
}

TEST(Ramp, NeverStopsUnlessTold) {
  BlockUnderTest ramp("Ramp", R"({"slope": 2})");
  ramp.evaluate(1e6);
  EXPECT_EQ(ramp.output("y"), 2e6);
  EXPECT_EQ(ramp.next_stop(0), infinity);
}

TEST(Ramp, KeepsItsPieceInsideASolverStep) {
  BlockUnderTest ramp("Ramp", R"({"slope": 1, "start": 1, "stop": 2})");
  ramp.evaluate(1.9);
  ramp.evaluate_held(2.5);
  EXPECT_DOUBLE_EQ(ramp.output("y"), 1.5);
}

TEST(Ramp, TellsTheSolverItsKinks) {
  BlockUnderTest ramp("Ramp", R"({"slope": 1, "start": 1, "stop": 2})");
  EXPECT_EQ(ramp.next_stop(0), 1);
  EXPECT_EQ(ramp.next_stop(1), 2);
  EXPECT_EQ(ramp.next_stop(2), infinity);
}

TEST(Ramp, BeginsAndEndsAtTheTimesThatWereMeant) {
  BlockUnderTest ramp("Ramp", R"({"slope": 1, "start": 0.00030000000000000003, "stop": 0.6000000000000001})");
  EXPECT_EQ(ramp.next_stop(0), 0.0003);
  EXPECT_EQ(ramp.next_stop(0.0003), 0.6);
  ramp.evaluate(0.6);
  EXPECT_EQ(ramp.output("y"), 0.6 - 0.0003);
}

TEST(Ramp, RefusesToStopBeforeItStarts) {
  BlockUnderTest ramp("Ramp", R"({"slope": 1, "start": 2, "stop": 1})");
  EXPECT_NE(ramp.problems().text().find("stops before it starts"), std::string::npos)
      << ramp.problems().text();
}

}  // namespace loopwright::ramp_test
