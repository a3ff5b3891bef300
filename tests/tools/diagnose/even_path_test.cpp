// A path with rows at uneven times, as effects with a memory are given it.
#include <gtest/gtest.h>
#include <cmath>
#include "tools/diagnose/predict/even_path.h"

namespace loopwright::even_path_test {
namespace {

using namespace diagnosis;

TEST(LinesOverIntervals, KeepAStraightLineIntegralsAndFirstMoments) {
  // f(t) = 3 + 2 t over intervals of any lengths, as the mean and the change of each.
  const std::vector<double> from{0, 0.7, 2.1, 3, 4.4}, to{0, 1, 2, 3, 4.4};
  LinesOver lines{from, {}, {}};
  for (size_t k = 0; k + 1 < from.size(); ++k) {
    lines.mean.push_back(3 + from[k] + from[k + 1]);
    lines.change.push_back(2 * (from[k + 1] - from[k]));
  }
  const LinesOver others = over(lines, to);
  for (size_t k = 0; k + 1 < to.size(); ++k) {
    EXPECT_NEAR(others.mean[k], 3 + to[k] + to[k + 1], 1e-12);
    EXPECT_NEAR(others.change[k], 2 * (to[k + 1] - to[k]), 1e-12);
  }
  // A leap within an interval: 0 up to 0.25, then 1. Mean 3/4; 12 times the first moment about the middle
  // 9/8.
  const LinesOver leap = over({{0, 0.25, 1}, {0, 1}, {0, 0}}, {0, 1});
  EXPECT_NEAR(leap.mean[0], 0.75, 1e-12);
  EXPECT_NEAR(leap.change[0], 12 * (0.75 * 0.125), 1e-12);
}

/// x = sin(w t) sampled at times that are up to 0.3 samples off.
TEST(EvenPath, FollowsAMotionSampledAtUnevenTimes) {
  constexpr double T = 1e-3, w = 40;
  Path path;
  path.sample_time = T;
  std::vector<double> time;
  for (int k = 0; k <= 500; ++k) time.push_back(T * (k + (k == 0 ? 0 : 0.3 * std::sin(7.0 * k * k))));
  for (size_t k = 0; k < 500; ++k) {
    path.duration.push_back((time[k + 1] - time[k]) / T);
    path.position.push_back(std::sin(w * time[k])), path.velocity.push_back(w * std::cos(w * time[k]));
    path.acceleration.push_back(-w * w * std::sin(w * time[k]));
    path.rests.push_back(0);
  }
  const EvenPath even(path);
  ASSERT_GE(even.rows(), 499u);
  const RoleSignals signals = even.signals();
  for (size_t k = 0; k < 499; ++k) {
    const double t = double(k) * T;
    EXPECT_NEAR(signals.position[k], std::sin(w * t), 1e-6) << k;      // 40 µm at this speed without
    EXPECT_NEAR(signals.velocity[k], w * std::cos(w * t), 4e-3) << k;  // 0.5 without
  }
  // What acts over the even samples acts over the rows at their times.
  std::vector<float> mean, change;
  for (size_t k = 0; k < even.rows(); ++k) mean.push_back(float(double(k) + 0.5)), change.push_back(1);
  even.to_rows(mean, change);
  ASSERT_EQ(mean.size(), path.samples());
  for (size_t k = 0; k < mean.size(); ++k) EXPECT_NEAR(mean[k], 0.5 * (time[k] + time[k + 1]) / T, 1e-3) << k;
}

}  // namespace
}  // namespace loopwright::even_path_test
