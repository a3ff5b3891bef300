#include "tools/studies/linear_motor/runs.h"
#include <gtest/gtest.h>
#include <cmath>
#include <stdexcept>
#include "tools/studies/linear_motor/frequency_response.h"
#include "where.h"

namespace loopwright::paper::runs_test {
namespace {

const std::string folder = LOOPWRIGHT_SOURCE "/diagrams/linear_motor/";

TEST(Runs, SpreadIsMeanAndSampleDeviation) {
  const Spread spread = spread_of(std::vector{1.0, 2.0, 4.0});
  EXPECT_DOUBLE_EQ(spread.mean, 7.0 / 3);
  EXPECT_NEAR(spread.deviation, std::sqrt(7.0 / 3), 1e-12);
  EXPECT_EQ(spread_of(std::vector{5.0}).deviation, 0);
}

TEST(Runs, RmsCountsTheRowsOfTheMotionAlone) {
  Recording recording;
  recording.columns = {{"time", "s", {0.4, 0.5, 0.6, 3.1, 3.2}}, {"error.sum", "m", {9, 3, 4, 5, 9}}};
  EXPECT_NEAR(tracking_rmse(recording), std::sqrt(50.0 / 3), 1e-12);
  EXPECT_NEAR(rms_between(recording, "error.sum", 0, 0.1), std::sqrt(25.0 / 2), 1e-12);
  EXPECT_THROW(rms_between(recording, "eror.sum", 0, 1), std::runtime_error);
}

TEST(Runs, OtherRunsHaveOtherNoiseAndTheSameRunTheSame) {
  const Controller conventional{"conventional", "", folder + "conventional.json", {}};
  const auto error = [&](int64_t run) { return tracking_rmse(track(conventional, paper_condition(), run)); };
  EXPECT_EQ(error(3), error(3));
  EXPECT_NE(error(3), error(4));
  const Spread spread = tracking_rmse(conventional, paper_condition(), 3, 2);
  EXPECT_DOUBLE_EQ(spread.mean, 0.5 * error(3) + 0.5 * error(4));
}

TEST(Runs, EveryConditionChangesTheLoop) {
  const Controller conventional{"conventional", "", folder + "conventional.json", {}};
  const double plain = tracking_rmse(track(conventional, held_out_condition()));
  for (const Condition& condition : harder_conditions())
    EXPECT_NE(tracking_rmse(track(conventional, condition)), plain) << condition.key;
}

TEST(Runs, AFailedRunSaysWhy) {
  const LoadOptions unstable{.set = {{"controller.Kp", "=1e9"},
                                     {"controller.Kd", "=1e9"},
                                     {"controller.largest_command", "=1e300"}}};
  EXPECT_THROW(run_diagram(folder + "conventional.json", unstable, 0), std::runtime_error);
}

TEST(FrequencyResponse, OfTheStageFollowsItsMassBeyondTenHertz) {
  const FrequencyResponse measured =
                              measured_response(run_diagram(folder + "frequency_response.json", {}, 0)),
                          nominal = nominal_response(measured.frequency_hz);
  ASSERT_EQ(measured.frequency_hz.size(), 196u);
  for (size_t i = 6; i < 96; ++i) {
    const auto ratio = measured.response[i] / nominal.response[i];
    EXPECT_NEAR(std::abs(ratio), 1, 0.1) << measured.frequency_hz[i] << " Hz";
    EXPECT_NEAR(std::arg(ratio), 0, 0.15) << measured.frequency_hz[i] << " Hz";
  }
}

TEST(FrequencyResponse, ShowsAnotherMass) {
  const FrequencyResponse loaded =
                              measured_response(run_diagram(folder + "frequency_response.json",
                                                            {.set = {{"stage.payload", "0.2621 kg"}}}, 0)),
                          nominal = nominal_response(loaded.frequency_hz);
  for (const size_t i : {25, 45, 75})
    EXPECT_NEAR(std::abs(loaded.response[i] / nominal.response[i]), 0.5, 0.05);
}

}  // namespace
}  // namespace loopwright::paper::runs_test
