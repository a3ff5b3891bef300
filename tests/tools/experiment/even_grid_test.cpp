// Rows of a record at their correct times, whatever is missing between them.
#include <gmock/gmock.h>
#include <algorithm>
#include <cmath>
#include <random>
#include "tools/experiment/even_grid.h"

namespace loopwright::even_grid_test {
namespace {

constexpr double dt = 1e-3;

Experiment record(const std::vector<double>& times) {
  Experiment experiment;
  Problems problems;
  experiment.data.columns.push_back({"time", "s", times});
  experiment.time = check_time(experiment.data.columns.front(), problems);
  EXPECT_FALSE(problems.has_errors()) << problems.text();
  return experiment;
}
std::vector<double> with_losses(int rows, const std::vector<int>& lost) {
  std::vector<double> times;
  for (int k = 0; k < rows; ++k)
    if (std::ranges::find(lost, k) == lost.end()) times.push_back(k * dt);
  return times;
}

TEST(EvenGrid, OneLostSampleMovesNoRowBehindIt) {
  const Experiment e = record(with_losses(1000, {400}));
  EXPECT_EQ(e.time.missing, 1);
  EXPECT_TRUE(e.time.on_grid);
  EXPECT_FALSE(e.time.regular);
  EXPECT_EQ(e.time.sample_time, dt) << "to the last bit";
  const EvenGrid grid(e);
  ASSERT_EQ(grid.rows(), 1000u);
  std::vector<double> position, command;
  for (double t : e.data.columns.front().values) position.push_back(std::sin(20 * t)), command.push_back(t);
  const std::vector<double> x = grid.measured(position), u = grid.driving(command, BetweenRows::hold).mean;
  for (size_t k = 0; k < 1000; ++k) {
    EXPECT_NEAR(x[k], std::sin(20 * double(k) * dt), k == 400 ? 1e-6 : 1e-12) << k;
    EXPECT_NEAR(u[k], (k == 400 ? 399 : double(k)) * dt, 1e-15) << k;
    EXPECT_EQ(grid.missing()[k], char(k == 400)) << k;
  }
}

TEST(EvenGrid, ADrivingSignalGoesOnOverALostSampleAsItDoesBetweenRows) {
  const Experiment e = record(with_losses(1000, {400}));
  const EvenGrid grid(e);
  std::vector<double> line, sine;
  constexpr double w = 100;
  for (double t : e.data.columns.front().values) line.push_back(3 * t), sine.push_back(std::sin(w * t));
  const OverSamples straight = grid.driving(line, BetweenRows::linear),
                    smooth = grid.driving(sine, BetweenRows::band_limited);
  EXPECT_TRUE(grid.driving(line, BetweenRows::hold).change.empty());
  ASSERT_EQ(straight.mean.size(), 1000u);
  ASSERT_EQ(smooth.change.size(), 1000u);
  for (size_t k = 0; k + 1 < 1000; ++k) {
    const double begin = double(k) * dt;
    EXPECT_NEAR(straight.mean[k], 3 * (begin + dt / 2), 1e-12) << k;
    EXPECT_NEAR(straight.change[k], 3 * dt, 1e-12) << k;
    EXPECT_NEAR(smooth.mean[k], (std::cos(w * begin) - std::cos(w * (begin + dt))) / (w * dt), 5e-6) << k;
    EXPECT_NEAR(smooth.change[k], dt * w * std::cos(w * (begin + dt / 2)), 1e-4) << k;
  }
}

TEST(EvenGrid, ManyLostSamplesKeepEveryRowInItsPlace) {
  std::mt19937 random(5);
  std::vector<int> lost;
  for (int k = 10; k < 20'000; ++k)
    if (random() % 100 == 0) lost.push_back(k);
  for (int k = 7000; k < 7500; ++k) lost.push_back(k);
  const std::vector<double> times = with_losses(20'000, lost);
  const Experiment e = record(times);
  EXPECT_TRUE(e.time.on_grid);
  EXPECT_EQ(e.time.missing, 20'000 - int64_t(times.size()));
  const EvenGrid grid(e);
  ASSERT_EQ(grid.rows(), 20'000u);
  const std::vector<double> t = grid.measured(times);
  for (size_t k = 0; k < t.size(); ++k) EXPECT_NEAR(t[k], double(k) * dt, 1e-9);
}

TEST(EvenGrid, StampsThatTrembleOrComeInABurstAreNoGaps) {
  std::mt19937 random(6);
  std::normal_distribution<double> tremble(0, 0.15 * dt);
  std::vector<double> times;
  for (int k = 0; k < 5000; ++k) times.push_back(k * dt + tremble(random));
  for (int k = 0; k < 10; ++k) times[size_t(2000 + k)] = 2.0095 + 1e-5 * k;  // ten late time stamps at once
  std::ranges::sort(times);
  const Experiment e = record(times);
  EXPECT_FALSE(e.time.on_grid);
  EXPECT_EQ(e.time.missing, 0);
  EXPECT_EQ(EvenGrid(e).rows(), 5000u);
  EXPECT_TRUE(EvenGrid(e).missing().empty());
}

TEST(EvenGrid, LossesAmongTremblingStampsAreCounted) {
  std::mt19937 random(7);
  std::normal_distribution<double> tremble(0, 0.1 * dt);
  std::vector<double> times;
  for (double t : with_losses(5000, {100, 101, 3000})) times.push_back(t + 5 * dt + tremble(random));
  const Experiment e = record(times);
  EXPECT_EQ(e.time.missing, 3);
  const EvenGrid grid(e);
  ASSERT_EQ(grid.rows(), 5000u);
  for (size_t k : {100, 101, 3000}) EXPECT_TRUE(grid.missing()[k]) << k;
}

/// Rows sampled at jittering instants, some of them lost; or evenly, with stamps that jitter.
Experiment jittering(bool samples_jitter) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> jitter(-0.3 * dt, 0.3 * dt);
  std::vector<double> times, position;
  for (int k = 0; k < 5000; ++k) {
    const double stamp = k * dt + (k ? jitter(random) : 0);
    if (k % 90 == 50) continue;
    times.push_back(stamp), position.push_back(std::sin(9 * (samples_jitter ? stamp : k * dt)));
  }
  Experiment e = record(times);
  e.data.columns.push_back({"x", "m", position});
  e.compared.emplace_back();
  e.compared.back().port = "x";
  return e;
}

TEST(EvenGrid, RowsSampledAtJitteringInstantsKeepThem) {
  const Experiment e = jittering(true);
  const EvenGrid grid(e);
  ASSERT_EQ(grid.rows(), 5000u);
  ASSERT_EQ(grid.duration().size(), 5000u);
  EXPECT_EQ(std::ranges::count(grid.missing(), char(1)), 55);
  const std::vector<double> x = grid.measured(e.data.columns[1].values);
  double t = grid.start();
  for (size_t k = 0; k < grid.rows(); ++k) {
    EXPECT_NEAR(x[k], std::sin(9 * t), 1e-6) << k;
    t += grid.duration()[k] * grid.sample_time();
  }
  const std::vector<double> even = at_even_instants(x, grid.duration());
  for (size_t k = 0; k < grid.rows(); ++k)
    EXPECT_NEAR(even[k], std::sin(9 * (grid.start() + double(k) * grid.sample_time())), 1e-6) << k;
}

TEST(EvenGrid, EvenRowsWithJitteringStampsAreEven) {
  const Experiment e = jittering(false);
  const EvenGrid grid(e);
  EXPECT_TRUE(grid.duration().empty());
  const std::vector<double> x = grid.measured(e.data.columns[1].values);
  ASSERT_EQ(x.size(), 5000u);
  for (size_t k = 0; k < x.size(); ++k) EXPECT_NEAR(x[k], std::sin(9 * double(k) * dt), 1e-6) << k;
}

TEST(EvenGrid, TheMeanOfAHeldCommandOverEvenSamplesKeepsItsSum) {
  const std::vector<double> held{1, 5, 2, 4}, duration{0.5, 1.5, 0.75, 1.25};
  const std::vector<double> mean = mean_over_even_samples(held, duration);
  EXPECT_THAT(mean, testing::ElementsAre(testing::DoubleEq(3), testing::DoubleEq(5), testing::DoubleEq(2.5),
                                         testing::DoubleEq(4)));
  EXPECT_EQ(mean_over_even_samples(held, {}), held);
}

TEST(OverOtherIntervals, AStraightLineStaysOne) {
  // f(t) = 3 + 2 t over intervals of any lengths, as the mean and the change of each.
  const std::vector<double> from{0, 0.7, 2.1, 3, 4.4}, to{0, 1, 2, 3, 4.4};
  OverSamples lines;
  for (size_t k = 0; k + 1 < from.size(); ++k) {
    lines.mean.push_back(3 + from[k] + from[k + 1]);
    lines.change.push_back(2 * (from[k + 1] - from[k]));
  }
  const OverSamples others = over_other_intervals(lines, from, to);
  for (size_t k = 0; k + 1 < to.size(); ++k) {
    EXPECT_NEAR(others.mean[k], 3 + to[k] + to[k + 1], 1e-12);
    EXPECT_NEAR(others.change[k], 2 * (to[k + 1] - to[k]), 1e-12);
  }
}

/// 0 up to 0.25, then 1. Mean 3/4; 12 times the first moment about the middle 9/8.
TEST(OverOtherIntervals, ALeapKeepsItsFirstMoment) {
  const OverSamples leap = over_other_intervals({{0, 1}, {0, 0}}, {0, 0.25, 1}, {0, 1});
  EXPECT_NEAR(leap.mean[0], 0.75, 1e-12);
  EXPECT_NEAR(leap.change[0], 12 * (0.75 * 0.125), 1e-12);
}

TEST(EvenGrid, ARecordWithMoreGapsThanRowsIsRefused) {
  std::vector<double> times = with_losses(1000, {});
  times.push_back(1e6);
  EXPECT_NE(too_many_missing(record(times)), "");
  EXPECT_EQ(too_many_missing(record(with_losses(1000, {3}))), "");
}

}  // namespace
}  // namespace loopwright::even_grid_test
