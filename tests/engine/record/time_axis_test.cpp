#include "engine/record/time_axis.h"

#include <gmock/gmock.h>

#include <limits>
#include <random>

#include "support.h"

namespace loopwright::time_axis_test {
namespace {

using testing::HasSubstr;

Column grid(double start, double step, int count, double printed_to = 0) {
  Column column{"time", "s", {}};
  for (int i = 0; i < count; ++i) {
    const double time = start + i * step;
    column.values.push_back(printed_to > 0 ? std::round(time / printed_to) * printed_to : time);
  }
  return column;
}

TEST(TimeAxis, FindsTheSampleTimeExactly) {
  for (const double step : {0.001, 1e-4, 0.004, 4.0, 1.0 / 3.0, 0.00025})
    for (const double start : {0.0, 0.1, -2.0}) {
      Problems problems;
      const TimeAxis axis = check_time(grid(start, step, 25'000), problems);
      EXPECT_TRUE(axis.regular);
      EXPECT_EQ(axis.start, start);
      EXPECT_NEAR(axis.sample_time, step, 1e-15 * step + 1e-12 * step * (step == 1.0 / 3.0 ? 0 : 1));
      EXPECT_EQ(problems.text(), "");
    }
  Problems problems;
  Column printed{"t", "s", {}};
  for (int i = 0; i < 24'841; ++i) printed.values.push_back(std::stod(std::to_string(i) + "e-3"));
  EXPECT_EQ(check_time(printed, problems).sample_time, 0.001) << "to the last bit";
}

TEST(TimeAxis, ToleratesRoundingAndNoMore) {
  Problems problems;
  EXPECT_TRUE(check_time(grid(0, 1.0 / 3000, 5000, 1e-6), problems).regular);
  EXPECT_EQ(problems.text(), "");
  Column jitter = grid(0, 0.001, 1000);
  jitter.values[500] += 0.00002;  // 2 % of a sample time
  EXPECT_FALSE(check_time(jitter, problems).regular);
  EXPECT_THAT(problems.text(), HasSubstr("a time lies 0.02 sample times off the grid"));
  Problems none;
  EXPECT_TRUE(check_time(jitter, none, {.tolerance = 0.05}).regular);
}

TEST(TimeAxis, RecognizesRoundedStamps) {
  for (const double rate : {750.0, 1024.0, 51200.0, 3.0})
    for (const double digit : {1e-4, 1e-6, 1e-7}) {
      if (digit > 0.4 / rate) continue;
      SCOPED_TRACE(testing::Message() << rate << " Hz, digit " << digit);
      Column stamps{"t", "s", {}};
      for (int k = 0; k < 20'000; ++k) stamps.values.push_back(std::round((0.3 + k / rate) / digit) * digit);
      Problems problems;
      const TimeAxis axis = check_time(stamps, problems);
      EXPECT_TRUE(axis.on_grid && axis.regular);
      EXPECT_EQ(axis.sample_time, 1 / rate) << "to the last bit";
      EXPECT_EQ(problems.text(), "");
      stamps.values.erase(stamps.values.begin() + 700);
      Problems of_gap;
      const TimeAxis with_gap = check_time(stamps, of_gap);
      EXPECT_TRUE(with_gap.on_grid && !with_gap.regular);
      EXPECT_EQ(with_gap.missing, 1);
      EXPECT_EQ(with_gap.sample_time, 1 / rate);
    }
}

/// As "%.9g" and many programs write them: the later, the fewer decimals.
TEST(TimeAxis, RecognizesStampsOfSignificantDigits) {
  for (const double rate : {750.0, 1024.0, 51200.0})
    for (const int digits : {7, 9}) {
      SCOPED_TRACE(testing::Message() << rate << " Hz, " << digits << " digits");
      Column stamps{"t", "s", {}};
      for (int k = 0; k < 5000; ++k)
        stamps.values.push_back(std::stod(fmt::format("{:.{}g}", k / rate, digits)));
      Problems problems;
      const TimeAxis axis = check_time(stamps, problems);
      EXPECT_TRUE(axis.on_grid && axis.regular);
      EXPECT_EQ(axis.sample_time, 1 / rate) << "to the last bit";
    }
}
/// A few written by hand are no rounded clock.
TEST(TimeAxis, TimesOfFewDigitsAreNoRoundedClock) {
  const Column stamps{"t", "s", {0.0005, 0.001, 1, 2, 3, 5}};
  Problems problems;
  EXPECT_FALSE(check_time(stamps, problems).on_grid);
}

TEST(TimeAxis, ShortRecordsOfWholeRatesAreNoOddDecimals) {
  for (const double rate : {300.0, 350.0, 70.0})
    for (const int rows : {150, 200, 300, 1000}) {
      Column stamps{"t", "s", {}};
      for (int k = 0; k < rows; ++k) stamps.values.push_back(std::round(1e3 * k / rate) / 1e3);
      Problems problems;
      EXPECT_EQ(check_time(stamps, problems).sample_time, 1 / rate) << rate << " Hz, " << rows << " rows";
    }
}

TEST(TimeAxis, RoundedStampsGiveTheInstantsOfTheSamples) {
  for (const int lost : {0, 3}) {
    std::vector<double> stamps, instants;
    for (int k = 0; k < 1000; ++k) {
      if (k >= 400 && k < 400 + lost) continue;
      stamps.push_back(std::round(1000 * (2 + k / 300.0)) / 1000), instants.push_back(2 + k / 300.0);
    }
    Problems problems;
    const std::vector<double> found = unrounded(stamps, check_time({"t", "s", stamps}, problems));
    ASSERT_EQ(found.size(), instants.size());
    for (size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], instants[i], 1e-12) << i;
  }
}

TEST(TimeAxis, OtherStampsAreUsedAsTheyAre) {
  const auto is_used = [](const std::vector<double>& stamps) {
    Problems problems;
    return unrounded(stamps, check_time({"t", "s", stamps}, problems)).empty();
  };
  EXPECT_TRUE(is_used(grid(0, 0.001, 1000).values)) << "exact";
  EXPECT_TRUE(is_used(grid(0.3, 1.0 / 3000, 5000).values)) << "exact";
  EXPECT_TRUE(is_used({0, 0.3, 0.7, 1, 1.3, 1.7, 2})) << "written by hand";
  std::mt19937_64 random(1);
  std::normal_distribution<double> late(0, 3e-4);
  std::vector<double> jitter;
  for (int k = 0; k < 2000; ++k) jitter.push_back(0.01 * k + std::abs(late(random)));
  EXPECT_TRUE(is_used(jitter)) << "off the grid by more than their digits";
}

TEST(TimeAxis, NamesGapsWithRowAndTime) {
  Column column = grid(0, 0.001, 100);
  column.values.erase(column.values.begin() + 50, column.values.begin() + 53);
  Problems problems;
  const TimeAxis axis = check_time(column, problems);
  EXPECT_FALSE(axis.regular);
  EXPECT_NEAR(axis.sample_time, 0.001, 1e-12);
  EXPECT_FALSE(problems.has_errors());
  EXPECT_THAT(problems.text(), HasSubstr("row 51: a gap of 0.004 s behind 0.049 s"));
  EXPECT_THAT(problems.text(), HasSubstr("about 3 samples are missing"));
  Problems strict;
  check_time(column, strict, {.must_be_regular = true});
  EXPECT_TRUE(strict.has_errors());
}

TEST(TimeAxis, RefusesTimesThatDoNotGrow) {
  const Column column{"t", "s", {0, 1, 1, 0.5, std::nan(""), 2, INFINITY}};
  Problems problems;
  const TimeAxis axis = check_time(column, problems);
  EXPECT_FALSE(axis.regular);
  EXPECT_EQ(axis.sample_time, 0);
  EXPECT_THAT(problems.text(), HasSubstr("row 3: the time 1 s of row 2 again"));
  EXPECT_THAT(problems.text(), HasSubstr("row 4: the time goes back from 1 s to 0.5 s"));
  EXPECT_THAT(problems.text(), HasSubstr("row 5: nan is no time"));
  EXPECT_THAT(problems.text(), HasSubstr("row 7: inf is no time"));
  EXPECT_THAT(problems.text(), HasSubstr("4 errors"));
}

TEST(TimeAxis, CapsItsProblems) {
  const Column column{"t", "s", std::vector<double>(1000, 1.0)};
  Problems problems;
  check_time(column, problems);
  EXPECT_EQ(problems.list().size(), 21u);
  EXPECT_THAT(problems.text(), HasSubstr("979 more problems"));
}

TEST(TimeAxis, AcceptsOneRowAndRefusesNone) {
  Problems problems;
  EXPECT_TRUE(check_time({"t", "s", {3}}, problems).regular);
  EXPECT_EQ(problems.text(), "");
  check_time({"t", "s", {}}, problems);
  EXPECT_THAT(problems.text(), HasSubstr("no rows"));
}

TEST(TimeAxis, SurvivesTheEndsOfTheNumberRange) {
  const double largest = std::numeric_limits<double>::max(),
               least = std::numeric_limits<double>::denorm_min();
  Problems problems;
  EXPECT_FALSE(check_time({"t", "s", {-largest, 0, largest}}, problems).regular);
  EXPECT_TRUE(check_time({"t", "s", {0, least}}, problems).regular);
}

TEST(TimeAxis, CarriesThePlaceItWasGiven) {
  const Place place{std::make_shared<SourceFile>(SourceFile{"axis.experiment.json", "{\n  \"time\": \"t\"}"}),
                    4};
  Problems problems;
  check_time({"t", "s", {1, 1}}, problems, {}, place);
  EXPECT_THAT(problems.text(), HasSubstr("axis.experiment.json:2:3: error"));
}

}  // namespace
}  // namespace loopwright::time_axis_test
