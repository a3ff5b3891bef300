// Records with more rows than a search can pass over.
#include "tools/diagnose/record/shorten.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <cmath>
#include <numbers>

namespace loopwright::diagnosis::shorten_test {
namespace {

/// First order: T y' = u - y, with u held, sampled exactly.
SignalRecord low_pass(size_t rows, double hz, double held_out) {
  constexpr double dt = 1e-3, time_constant = 0.05;
  SignalRecord record;
  record.inputs.push_back({"u", "1", BetweenRows::hold, {}}), record.outputs.push_back({"y", "1", 0, {}});
  double y = 0;
  for (size_t k = 0; k < rows; ++k) {
    const double u = std::sin(2 * std::numbers::pi * hz * double(k) * dt);
    record.time.push_back(double(k) * dt), record.inputs[0].value.push_back(u);
    record.outputs[0].value.push_back(y);
    y = u + (y - u) * std::exp(-dt / time_constant);
  }
  record.sample_time = dt, record.held_out_from = size_t(double(rows) * (1 - held_out));
  return record;
}
/// The same law, with straight lines between the rows.
double largest_error_of_law(const SignalRecord& record) {
  constexpr double time_constant = 0.05;
  double worst = 0;
  for (size_t k = 0; k + 1 < record.rows(); ++k) {
    if (record.begins_at(k + 1)) continue;
    const double h = record.time[k + 1] - record.time[k], left = std::exp(-h / time_constant);
    const std::vector<double>&u = record.inputs[0].value, &y = record.outputs[0].value;
    const double slope = (u[k + 1] - u[k]) / h;
    const double next = (y[k] - u[k] + slope * time_constant) * left + u[k + 1] - slope * time_constant;
    worst = std::max(worst, std::abs(next - y[k + 1]));
  }
  return worst;
}

TEST(Shorten, AShortRecordIsLeftAsItIs) {
  std::vector<SignalRecord> records{low_pass(1000, 3, 0.25)};
  EXPECT_FALSE(shorten(records, 1000));
  EXPECT_EQ(records[0].rows(), 1000u);
  EXPECT_EQ(records[0].inputs[0].between_rows, BetweenRows::hold);
}
TEST(Shorten, MeansOfRowsFollowTheSameLaw) {
  std::vector<SignalRecord> records{low_pass(6000, 3, 0.25), low_pass(4000, 3, 0)};
  const auto finding = shorten(records, 2000);
  ASSERT_TRUE(finding);
  EXPECT_THAT(finding->what, testing::HasSubstr("10000 rows"));
  EXPECT_THAT(finding->what, testing::HasSubstr("means of 5 rows stand for them, 5 ms apart"));
  EXPECT_EQ(records[0].rows() + records[1].rows(), 2000u);
  EXPECT_EQ(records[0].held_out_from, 900u);
  EXPECT_NEAR(records[0].time[1] - records[0].time[0], 5e-3, 1e-12);
  for (const SignalRecord& record : records) {
    EXPECT_EQ(record.inputs[0].between_rows, BetweenRows::linear);
    EXPECT_LT(largest_error_of_law(record), 2e-4) << "a shift by half a row alone would be 9e-4";
  }
}
TEST(Shorten, WhatIsAboveHalfOfTheNewRateIsAveragedAwayAndNotAliased) {
  std::vector<SignalRecord> records{low_pass(10000, 0.5, 0)};
  for (size_t k = 0; k < 10000; ++k) records[0].outputs[0].value[k] += k % 2 ? 0.02 : -0.02;  // 500 Hz
  const std::vector<double> with_noise = records[0].outputs[0].value;
  ASSERT_TRUE(shorten(records, 2500));
  std::vector<SignalRecord> clean{low_pass(10000, 0.5, 0)};
  ASSERT_TRUE(shorten(clean, 2500));
  for (size_t k = 0; k < clean[0].rows(); ++k)
    ASSERT_NEAR(records[0].outputs[0].value[k], clean[0].outputs[0].value[k], 1e-12);
}
TEST(Shorten, AFastSignalIsNotAveragedButItsFirstRowsAreTaken) {
  std::vector<SignalRecord> records{low_pass(8000, 60, 0.25)};
  const SignalRecord before = records[0];
  const auto finding = shorten(records, 2000);
  ASSERT_TRUE(finding);
  EXPECT_THAT(finding->what, testing::HasSubstr("the first 25 % of them are used"));
  EXPECT_THAT(finding->cost, testing::HasSubstr("what happens later is not seen"));
  ASSERT_EQ(records[0].rows(), 2000u);
  EXPECT_EQ(records[0].held_out_from, 1500u);
  EXPECT_TRUE(records[0].begins_at(1500)) << "rows are left out before it";
  EXPECT_EQ(records[0].outputs[0].value[100], before.outputs[0].value[100]);
  EXPECT_EQ(records[0].outputs[0].value[1500], before.outputs[0].value[6000]);
}
TEST(Shorten, NoMeanLiesAcrossAGap) {
  std::vector<SignalRecord> records{low_pass(4000, 1, 0)};
  for (size_t k = 1001; k < 4000; ++k) records[0].time[k] += 5;
  ASSERT_TRUE(shorten(records, 1000));
  for (double t : records[0].time) EXPECT_TRUE(t < 1.001 || t > 6) << t;
}

}  // namespace
}  // namespace loopwright::diagnosis::shorten_test
