#include <gtest/gtest.h>
#include "tests/blocks/block_under_test.h"

namespace loopwright::motion_profile_test {

namespace {

/// The common job: 0.6 m in 2.6 s.
std::string common_job(const std::string& more = "") {
  return R"({"segments": [{"duration": 0.05, "velocity": 0}, {"duration": 0.2, "velocity": 0.15},
      {"duration": 0.7375, "velocity": 0.15}, {"duration": 0.2, "velocity": 0.35}, {"duration": 1.0625, "velocity": 0.35},
      {"duration": 0.3, "velocity": 0}, {"duration": 0.05, "velocity": 0}])" +
         more + "}";
}

}  // namespace

TEST(MotionProfile, TravelsTheSumOfItsMeanVelocities) {
  BlockUnderTest motion("MotionProfile", common_job());
  motion.evaluate(2.6);
  EXPECT_NEAR(motion.output("position"), 0.6, 1e-15);
  EXPECT_EQ(motion.output("velocity"), 0);
  EXPECT_EQ(motion.output("acceleration"), 0);
  motion.evaluate(100);
  EXPECT_NEAR(motion.output("position"), 0.6, 1e-15);
}

TEST(MotionProfile, RaisedCosineRampsFollowTheirFormula) {
  BlockUnderTest motion("MotionProfile", common_job());
  motion.evaluate(0.05 + 0.2 / 3);
  EXPECT_NEAR(motion.output("velocity"), 0.15 * 0.25, 1e-15);  // (1 - cos 60°)/2 = 1/4
  EXPECT_NEAR(motion.output("acceleration"), 0.15 * 0.5 * pi / 0.2 * std::sin(pi / 3), 1e-14);
  motion.evaluate(0.05 + 0.2 + 0.5);
  EXPECT_NEAR(motion.output("velocity"), 0.15, 1e-15);
  EXPECT_NEAR(motion.output("position"), 0.015 + 0.5 * 0.15, 1e-15);
  EXPECT_NEAR(motion.output("acceleration"), 0, 1e-15);
}

/// Position against a fine Simpson sum of velocity, velocity against differences of position.
TEST(MotionProfile, PositionVelocityAndAccelerationBelongTogetherForEveryShape) {
  for (const char* shape : {"raised_cosine", "cubic", "linear"}) {
    BlockUnderTest motion(
        "MotionProfile",
        common_job(R"(, "start_position": 1, "returns": true, "shape": ")" + std::string(shape) + "\""));
    const double h = 1e-4;
    double sum = 1, last_velocity = 0, last_acceleration = 0, jump = 0;
    for (int i = 0; i < 52000; ++i) {
      motion.evaluate((i + 0.5) * h);
      const double middle = motion.output("velocity");
      motion.evaluate((i + 1) * h);
      const double velocity = motion.output("velocity"), acceleration = motion.output("acceleration");
      sum += h / 6 * (last_velocity + 4 * middle + velocity);
      ASSERT_NEAR(motion.output("position"), sum, 1e-9) << shape << " at " << (i + 1) * h;
      ASSERT_NEAR(velocity - last_velocity, 0.5 * h * (acceleration + last_acceleration), 2e-4) << shape;
      jump = std::max(jump, std::abs(acceleration - last_acceleration));
      last_velocity = velocity, last_acceleration = acceleration;
    }
    EXPECT_NEAR(sum, 1, 1e-9) << shape;
    if (std::string_view(shape) == "linear")
      EXPECT_GT(jump, 0.7) << shape;
    else
      EXPECT_LT(jump, 0.01) << shape;
  }
}

TEST(MotionProfile, ReturnsAsTheMirrorImageInTime) {
  BlockUnderTest motion("MotionProfile", common_job(R"(, "returns": true, "passes": 3)"));
  for (double t : {0.1, 0.2, 1.0, 1.1, 2.0, 2.5}) {
    motion.evaluate(t);
    const double position = motion.output("position"), velocity = motion.output("velocity"),
                 acceleration = motion.output("acceleration");
    for (double mirror : {5.2 - t, 10.4 - t, 15.6 - t}) {
      motion.evaluate(mirror);
      EXPECT_NEAR(motion.output("position"), position, 1e-13) << mirror;
      EXPECT_NEAR(motion.output("velocity"), -velocity, 1e-12) << mirror;
      EXPECT_NEAR(motion.output("acceleration"), acceleration, 1e-11) << mirror;
    }
  }
  motion.evaluate(20);
  EXPECT_EQ(motion.output("position"), 0);
  EXPECT_EQ(motion.next_stop(20), infinity);
}

TEST(MotionProfile, PassesWithoutReturnGoOnFromWhereTheyCame) {
  BlockUnderTest motion("MotionProfile", common_job(R"(, "passes": 0)"));
  motion.evaluate(10 * 2.6 + 0.5);
  const double position = motion.output("position");
  motion.evaluate(0.5);
  EXPECT_NEAR(position, 6 + motion.output("position"), 1e-12);
}

TEST(MotionProfile, WaitsForItsStart) {
  BlockUnderTest motion("MotionProfile", common_job(R"(, "start": 3, "start_position": 0.25)"));
  for (double t : {0.0, 2.99, 3.04}) {
    motion.evaluate(t);
    EXPECT_EQ(motion.output("position"), 0.25);
    EXPECT_EQ(motion.output("velocity"), 0);
  }
  EXPECT_EQ(motion.next_stop(0), 3);
}

/// From stop to stop every piece must start exactly at its beginning, whatever the rounding.
TEST(MotionProfile, EntersANewPieceAtEveryStopThatItAnnounces) {
  BlockUnderTest motion("MotionProfile", R"({"shape": "linear", "passes": 0, "segments": [
      {"duration": 0.1, "velocity": 1}, {"duration": 0.7, "velocity": 0}, {"duration": 0.3, "velocity": 0}]})");
  const double acceleration[] = {10, -1 / 0.7, 0};
  double t = 0;
  for (int stop = 0; stop < 3000;) {
    motion.evaluate(t);
    const double next = motion.next_stop(t);
    ASSERT_GT(next, t);
    if (next - t > 1e-9) {  // the end of a pass and the start of the next may differ by rounding
      ASSERT_NEAR(motion.output("acceleration"), acceleration[stop % 3], 1e-12) << t;
      ++stop;
    }
    t = next;
  }
  EXPECT_NEAR(t, 1000 * 1.1, 1e-9);
}

/// Ten segments of a tenth, repeatedly: each begins on its exact tick, up to a billion samples.
TEST(MotionProfile, ItsPiecesBeginOnTheirVeryTicks) {
  std::string segments;
  for (int i = 0; i < 10; ++i)
    segments +=
        std::string(i ? ", " : "") + R"({"duration": 0.1, "velocity": )" + std::to_string(i % 2) + "}";
  BlockUnderTest motion("MotionProfile",
                        R"({"shape": "linear", "passes": 0, "start_velocity": 1, "start": 0.3,
      "segments": [)" + segments +
                            "]}");
  for (const int64_t from : {int64_t(3), int64_t(10'000'003)})
    for (int64_t piece = 0; piece < 200; ++piece) {
      const int64_t tick = from + piece;  // tenths
      motion.evaluate(double(tick) / 10, tick);
      ASSERT_EQ(motion.output("velocity"), piece % 2 ? 0 : 1) << tick;
      ASSERT_EQ(motion.output("acceleration"), piece % 2 ? 1 / 0.1 : -1 / 0.1) << tick;
      ASSERT_EQ(motion.next_stop(double(tick) / 10), double(tick + 1) / 10) << tick;
    }
}

TEST(MotionProfile, ItsVelocitiesAreTunable) {
  BlockUnderTest motion("MotionProfile", common_job());
  motion.tune("segments.3.velocity", 0.25);
  motion.tune("segments.4.velocity", 0.25);
  motion.evaluate(2.6);
  EXPECT_NEAR(motion.output("position"), 0.015 + 0.110625 + 0.04 + 0.265625 + 0.0375, 1e-15);
}

TEST(MotionProfile, RefusesMotionsThatJump) {
  const auto text = [](const char* settings) {
    return BlockUnderTest("MotionProfile", settings).problems().text();
  };
  EXPECT_NE(text(R"({"segments": []})").find("at least one segment"), std::string::npos);
  EXPECT_NE(text(R"({"segments": [{"duration": 1, "velocity": 1}], "returns": true})").find("turns back"),
            std::string::npos);
  EXPECT_NE(text(R"({"segments": [{"duration": 1, "velocity": 1}], "passes": 2})").find("follows the other"),
            std::string::npos);
  EXPECT_NE(text(R"({"segments": [{"duration": 0, "velocity": 1}]})").find("above 0"), std::string::npos);
}

}  // namespace loopwright::motion_profile_test
