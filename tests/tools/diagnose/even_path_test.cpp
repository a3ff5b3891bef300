// A path with rows at uneven times, as effects with a memory are given it.
#include <gtest/gtest.h>
#include <cmath>
#include "tools/diagnose/predict/even_path.h"

namespace loopwright::even_path_test {
namespace {

using namespace diagnosis;

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

/// A held command that comes 0.625 samples late: in eighths of a sample, what it is over each row is known
/// from where the rows begin.
TEST(EvenPath, ShowsInPartsOfASampleWhatACommandThatComesLateIsOverARow) {
  Path path;
  path.sample_time = 1e-3;
  std::vector<double> edge{0};
  for (int k = 0; k < 300; ++k) {
    path.duration.push_back(k == 0 ? 1 : 1 + 0.3 * std::sin(7.0 * k * k));
    edge.push_back(edge.back() + path.duration.back());
    path.input.push_back(std::sin(3.0 * k * k));
    path.rests.push_back(0);
  }
  path.position = path.velocity = path.acceleration = std::vector<double>(300);
  constexpr int parts = 8, late_parts = 5;
  constexpr double late = double(late_parts) / parts;
  const EvenPath even(path, parts);
  const auto given = even.signals().input;
  std::vector<float> mean, change(even.rows());
  for (size_t i = 0; i < even.rows(); ++i) mean.push_back(i < late_parts ? 0 : float(given[i - late_parts]));
  even.to_rows(mean, change);
  for (size_t k = 3; k < 299; ++k) {
    double exact = 0;  // the rows before that still act in it
    for (size_t j = k - 3; j <= k; ++j)
      exact += path.input[j] *
               std::max(0.0, std::min(edge[k + 1], edge[j + 1] + late) - std::max(edge[k], edge[j] + late));
    // The step at the begin of a row is known to within an eighth, and half of it on either side.
    EXPECT_NEAR(mean[k], exact / path.duration[k], 0.1) << k;
  }
}

}  // namespace
}  // namespace loopwright::even_path_test
