#include "tools/compare/zero_phase.h"
#include "models/real/whole.h"
#include <algorithm>
#include <cmath>
#include <numbers>

namespace loopwright {
namespace {

using std::numbers::pi;

/// One pair of poles, b0 (1 + z⁻¹)² / (1 + a1 z⁻¹ + a2 z⁻²), in transposed direct form II.
struct Section {
  double b0, a1, a2;

  Section(double warped, double quality) {
    const double square = warped * warped, denominator = 1 + warped / quality + square;
    b0 = square / denominator;
    a1 = 2 * (square - 1) / denominator;
    a2 = (1 - warped / quality + square) / denominator;
  }
  /// In place; starts in steady state at the first value.
  void run(std::vector<double>& values) const {
    double s1 = values.front() * (1 - b0), s2 = values.front() * (b0 - a2);
    for (double& value : values) {
      const double y = b0 * value + s1;
      s1 = 2 * b0 * value - a1 * y + s2;
      s2 = b0 * value - a2 * y;
      value = y;
    }
  }
};

}  // namespace

std::vector<double> zero_phase_low_pass(std::span<const double> values, double cutoff, double sample_time) {
  const size_t n = values.size();
  if (n < 8 || cutoff * sample_time >= 0.45) return {values.begin(), values.end()};
  const size_t margin = std::min(n - 1, whole_count(std::ceil(3 / (cutoff * sample_time))));
  std::vector<double> x;
  for (size_t i = margin; i > 0; --i) x.push_back(2 * values[0] - values[i]);
  x.insert(x.end(), values.begin(), values.end());
  for (size_t i = 1; i <= margin; ++i) x.push_back(2 * values[n - 1] - values[n - 1 - i]);
  const double warped = std::tan(pi * cutoff * sample_time);
  const Section sections[] = {{warped, 1 / (2 * std::cos(pi / 8))}, {warped, 1 / (2 * std::cos(3 * pi / 8))}};
  for (int pass = 0; pass < 2; ++pass) {
    for (const Section& section : sections) section.run(x);
    std::ranges::reverse(x);
  }
  return {x.begin() + ptrdiff_t(margin), x.begin() + ptrdiff_t(margin + n)};
}

}  // namespace loopwright
