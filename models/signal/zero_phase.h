/// Zero-phase filters for complete records: they use future and past samples alike.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace loopwright {

/// A second-order Butterworth low pass, run forwards and then backwards: gain 1/(1 + (ω/ω_c)⁴), no phase. It
/// starts and ends as if the signal had been constant at its first and last value; results closer to the ends
/// than 4/ω_c are unreliable. `cutoff` ω_c in rad/s, below π/sample_time; `sample_time` in s.
inline std::vector<double> zero_phase_low_pass(std::vector<double> x, double cutoff, double sample_time) {
  const double w = std::tan(std::min(0.5 * cutoff * sample_time, 0.49 * std::numbers::pi));  // prewarped
  const double scale = 1 / (1 + std::numbers::sqrt2 * w + w * w);
  const double b = w * w * scale, a1 = 2 * (w * w - 1) * scale,
               a2 = (1 - std::numbers::sqrt2 * w + w * w) * scale;
  const auto run = [&] {
    if (x.empty()) return;
    double u1 = x[0], u2 = x[0], y1 = x[0], y2 = x[0];
    for (double& value : x) {
      const double u = value, y = b * (u + 2 * u1 + u2) - a1 * y1 - a2 * y2;
      u2 = u1, u1 = u, y2 = y1, y1 = y;
      value = y;
    }
  };
  for (int pass = 0; pass < 2; ++pass) {
    run();
    std::ranges::reverse(x);
  }
  return x;
}

/// Central differences; one-sided at the ends.
inline std::vector<double> central_difference(const std::vector<double>& x, double sample_time) {
  std::vector<double> slope(x.size(), 0.0);
  for (size_t i = 0; i < x.size(); ++i) {
    const size_t before = i == 0 ? 0 : i - 1, after = std::min(i + 1, x.size() - 1);
    if (after > before) slope[i] = (x[after] - x[before]) / (sample_time * double(after - before));
  }
  return slope;
}

}  // namespace loopwright
