// Time is tick times base: rows are neither lost nor shifted, and times are the nearest floating-point
// numbers.
#include <gtest/gtest.h>
#include "tests/engine/written_diagram.h"

namespace loopwright::time_test {
namespace {

TEST(RunTime, TenSecondsAtATenthAreExactly101Rows) {
  for (const char* solver :
       {R"("stop": 10, "step": 0.1)", R"("stop": 10, "method": "dopri5", "record_step": 0.1)",
        R"("stop": 10, "method": "cvode-bdf", "record_step": 0.1)"}) {
    const RunResult result = run_of(
        diagram(R"("t": {"type": "Clock"}, "x": {"type": "Integrator", "in": {"u": "t.time"}})", solver));
    ASSERT_EQ(result.recording.rows(), 101u) << solver;
    for (size_t i = 0; i <= 100; ++i) {
      EXPECT_EQ(signal(result, "time")[i], double(i) / 10) << solver;
      EXPECT_EQ(signal(result, "t.time")[i], double(i) / 10) << solver;
    }
    EXPECT_EQ(result.time, 10);
  }
}

TEST(RunTime, AMillionTicksDoNotDrift) {
  const RunResult result = run_of(diagram(
      R"("t": {"type": "Clock"}, "d": {"type": "Delay", "samples": 1, "sample_time": 0.0001, "in": {"u": "t.time"}})",
      R"("stop": 100, "record_step": 0.1)"));
  ASSERT_EQ(result.recording.rows(), 1001u);
  for (size_t i = 1; i < 1001; ++i) {
    ASSERT_EQ(signal(result, "time")[i], double(i * 1000) / 10000);
    ASSERT_EQ(signal(result, "d.y")[i], double(i * 1000 - 1) / 10000) << "one sample ago, and not two";
  }
}

TEST(RunTime, ThirdsAreTheNearestNumbersToo) {
  const RunResult result =
      run_of(diagram(R"("t": {"type": "Clock", "sample_time": "=1/3000"})", R"("stop": 1)"));
  ASSERT_EQ(result.recording.rows(), 3001u);
  for (size_t i = 0; i < 3001; ++i) ASSERT_EQ(signal(result, "t.time")[i], double(i) / 3000);
}

TEST(RunTime, RowsAreCountedFromTheStart) {
  for (const char* method : {R"("step": 0.05)", R"("method": "dopri5")"}) {
    const RunResult result =
        run_of(diagram(R"("t": {"type": "Clock"}, "x": {"type": "Integrator", "in": {"u": "t.time"}})",
                       fmt::format(R"("start": 0.35, "stop": 1, "record_step": 0.1, {})", method)));
    ASSERT_EQ(result.recording.rows(), 8u);
    EXPECT_EQ(signal(result, "time")[0], 0.35);
    EXPECT_EQ(signal(result, "time")[6], 0.95);
    EXPECT_EQ(signal(result, "time")[7], 1.0) << "the stop has a row always";
    EXPECT_NEAR(signal(result, "x.y")[7], (1 - 0.35 * 0.35) / 2, 1e-12);
  }
}

TEST(RunTime, ALateStartNeedsNoRoomForTheTimeBefore) {
  const RunResult result = run_of(diagram(
      R"("t": {"type": "Clock"})", R"("start": 1e9, "stop": 1000000001, "step": 0.5, "record_step": 0.5)"));
  EXPECT_EQ(result.recording.rows(), 3u);
}

TEST(RunTime, ARecordingThatWouldNotFitIsRefusedBeforeTheRun) {
  const auto plan = plan_of(diagram(R"("t": {"type": "Clock"})", R"("stop": 1e6, "step": 1e-4)"));
  try {
    simulate(*plan);
    FAIL() << "80 GB";
  } catch (const InputError& error) {
    EXPECT_TRUE(has(error.what(), "record_step")) << error.what();
  }
}

}  // namespace
}  // namespace loopwright::time_test
