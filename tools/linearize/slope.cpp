#include "tools/linearize/slope.h"
#include <algorithm>
#include <cmath>
#include <limits>

namespace loopwright {
namespace {

constexpr int levels = 15;
constexpr double ratio = 7, first_step = 0.7310;  // steps that are no multiples of a block's period
constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// One element of f at x and at both ends of every step.
struct Samples {
  double centre;
  double step[levels], above[levels], below[levels];

  double central(int level) const { return (above[level] - below[level]) / (2 * step[level]); }
  double forward(int level) const { return (above[level] - centre) / step[level]; }
  double backward(int level) const { return (centre - below[level]) / step[level]; }
  double extrapolated(int level) const {
    return central(level + 1) + (central(level + 1) - central(level)) / (ratio * ratio - 1);
  }
  double rounding(int level) const {
    return epsilon * std::max({std::abs(above[level]), std::abs(below[level]), std::abs(centre)}) /
           step[level];
  }
};

struct Estimate {
  double value = nan, error = std::numeric_limits<double>::infinity();
  int level = -1;
  void offer(double candidate, double how_wrong, int at) {
    if (how_wrong < error) value = candidate, error = how_wrong, level = at;
  }
};

Estimate best_estimate(const Samples& s) {
  Estimate best;
  for (int i = 0; i + 2 < levels; ++i) {
    const double a = s.central(i), b = s.central(i + 1), c = s.central(i + 2);
    best.offer(a, std::max(std::abs(a - b), std::abs(b - c)) + s.rounding(i), i);
  }
  for (int i = 1; i + 2 < levels; ++i) {
    const double before = s.extrapolated(i - 1), here = s.extrapolated(i), after = s.extrapolated(i + 1);
    best.offer(here, std::max(std::abs(here - before), std::abs(here - after)) + s.rounding(i + 1), i);
  }
  return best;
}

/// The two one-sided slopes of a smooth function converge with the step; at a corner they stay different.
bool is_corner(const Samples& s, int level) {
  const int finer = std::min(level + 2, levels - 1);
  const auto gap = [&](int i) { return std::abs(s.forward(i) - s.backward(i)); };
  const double size = std::max(std::abs(s.forward(finer)), std::abs(s.backward(finer)));
  return finer > level && gap(finer) > 0.5 * gap(level) && gap(finer) > 1e-3 * size &&
         gap(finer) > 100 * s.rounding(finer);
}

double steepest(const Samples& s) {
  double size = 0;
  for (int i = 0; i < levels; ++i)
    for (double slope : {s.forward(i), s.backward(i)})
      if (std::isfinite(slope)) size = std::max(size, std::abs(slope));
  return size;
}

}  // namespace

Slope slope(const FunctionOfNumber& f, double x, size_t size) {
  std::vector<Samples> samples(size);
  std::vector<double> value(size);
  const auto sample = [&](double at, auto store) {
    if (!f(at, value)) std::ranges::fill(value, nan);
    for (size_t i = 0; i < size; ++i) store(samples[i], value[i]);
  };
  sample(x, [](Samples& s, double y) { s.centre = y; });
  double step = first_step * std::max(std::abs(x), 1.0);
  for (int level = 0; level < levels; ++level, step /= ratio) {
    const volatile double right = x + step, left = x - step;  // so that this is exactly the step taken
    const double taken = (right - left) / 2;
    sample(right, [&](Samples& s, double y) { s.above[level] = y, s.step[level] = taken; });
    sample(left, [&](Samples& s, double y) { s.below[level] = y; });
  }
  Slope result;
  for (const Samples& s : samples) {
    const Estimate best = best_estimate(s);
    const bool corner = best.level >= 0 && is_corner(s, best.level);
    result.value.push_back(best.value);
    result.error.push_back(best.error);
    result.size.push_back(steepest(s));
    result.left.push_back(corner ? s.backward(best.level + 2) : best.value);
    result.right.push_back(corner ? s.forward(best.level + 2) : best.value);
  }
  return result;
}

}  // namespace loopwright
