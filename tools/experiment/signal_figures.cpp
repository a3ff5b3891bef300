#include "tools/experiment/signal_figures.h"
#include <algorithm>
#include <cmath>
#include <numeric>
#include "models/real/whole.h"

namespace loopwright {
namespace {

/// rms(x[k + lag] - x[k]) over every step-th k.
double difference_after(std::span<const double> x, size_t lag, size_t step) {
  double sum = 0;
  size_t n = 0;
  for (size_t k = 0; k + lag < x.size(); k += step, ++n) sum += (x[k + lag] - x[k]) * (x[k + lag] - x[k]);
  return n ? std::sqrt(sum / double(n)) : 1e300;
}

}  // namespace

std::array<double, 4> weights_of_cubic(std::span<const double> at, size_t row,
                                       const std::array<size_t, 4>& around) {
  std::array<double, 4> weights{1, 1, 1, 1};
  for (size_t j = 0; j < around.size(); ++j)
    for (const size_t other : around)
      if (other != around[j]) weights[j] *= (at[row] - at[other]) / (at[around[j]] - at[other]);
  return weights;
}

double roughness(std::span<const double> at, std::span<const double> value) {
  constexpr size_t reach = 2, most = 20000;
  const size_t n = value.size(), step = std::max<size_t>(1, n / most);
  std::vector<std::pair<double, double>> rows;  // speed, deviation
  for (size_t i = reach; i + reach < n; i += step) {
    const std::array<size_t, 4> around{i - 2, i - 1, i + 1, i + 2};
    const std::array<double, 4> weights = weights_of_cubic(at, i, around);
    double deviation = value[i], squares = 1;
    for (size_t j = 0; j < around.size(); ++j)
      deviation -= weights[j] * value[around[j]], squares += weights[j] * weights[j];
    rows.emplace_back(std::abs(value[i + reach] - value[i - reach]),
                      std::abs(deviation) / std::sqrt(squares));
  }
  if (rows.size() < 20) return 0;
  const auto half = rows.begin() + std::ptrdiff_t(rows.size() / 2);
  std::ranges::nth_element(rows, half);
  const auto middle = half + (rows.end() - half) / 2;
  std::ranges::nth_element(half, middle, rows.end(), {}, &std::pair<double, double>::second);
  return middle->second;
}

double noise_of(std::span<const double> at, std::span<const double> value) {
  constexpr double median_of_normal = 0.67449;  // of the size of a normal variable with deviation 1
  return roughness(at, value) / median_of_normal;
}

std::vector<size_t> outliers(std::span<const double> value, double factor) {
  std::vector<double> leap;
  for (size_t k = 1; k + 1 < value.size(); ++k)
    leap.push_back(std::abs(value[k + 1] - 2 * value[k] + value[k - 1]));
  std::vector<size_t> rows;
  if (leap.empty()) return rows;
  std::vector<double> sorted = leap;
  const size_t near_top = sorted.size() * 95 / 100;
  std::ranges::nth_element(sorted, sorted.begin() + ptrdiff_t(near_top));
  const double usual = sorted[near_top];
  for (size_t i = 1; i + 1 < leap.size(); ++i)
    if (leap[i] > factor * usual + 1e-300 && leap[i] > 1.5 * leap[i - 1] && leap[i] > 1.5 * leap[i + 1])
      rows.push_back(i + 1);
  return rows;
}

size_t rows_until_repeat(std::span<const double> value, double sample_time) {
  if (value.empty()) return 0;
  const auto [low, high] = std::ranges::minmax(value);
  const double stroke = high - low, allowed = 0.003 * stroke;
  const size_t n = value.size(), coarse = std::max<size_t>(1, whole_count(0.02 / sample_time));
  bool has_left = false;  // the signal is also similar to itself after a short time
  size_t best = 0;
  double least = 1e300;
  for (size_t lag = coarse; lag < 2 * n / 3; lag += coarse) {
    const double d = difference_after(value, lag, coarse);
    has_left |= d > 0.1 * stroke;
    if (!has_left) continue;
    if (d < least) least = d, best = lag;
    if (least < 4 * allowed && d > 2 * least) break;  // the first of several repeats
  }
  if (best == 0) return 0;
  size_t fine = best;
  least = 1e300;
  for (size_t lag = best - coarse; lag <= best + coarse && lag < n; ++lag)
    if (const double d = difference_after(value, lag, 7); d < least) least = d, fine = lag;
  return least < allowed ? fine : 0;
}

double resolution_of(std::span<const double> value) {
  constexpr double rounding = 1e-12;  // of the greatest value: two numbers that were meant to be one
  constexpr double off_grid = 0.02;   // of a step
  constexpr size_t least_steps = 3;   // two values lie on a grid of any signal
  std::vector<double> sorted(value.begin(), value.end());
  std::ranges::sort(sorted);
  if (sorted.empty()) return 0;
  const double equal = rounding * std::max(std::abs(sorted.front()), std::abs(sorted.back()));
  double step = 0;
  std::vector<double> level = {sorted.front()};
  for (double v : sorted) {
    if (v - level.back() <= equal) continue;
    step = step == 0 ? v - level.back() : std::min(step, v - level.back());
    level.push_back(v);
  }
  if (level.size() <= least_steps) return 0;
  // The step is refined from level to level: its error would add up over many of them.
  for (double v : level) {
    const double count = std::round((v - level.front()) / step);
    if (std::abs((v - level.front()) / step - count) > off_grid) return 0;
    if (count > 0 && count < 1e6) step = (v - level.front()) / count;
  }
  return step;
}

size_t rows_between_changes(std::span<const double> value) {
  constexpr size_t least_changes = 10;
  size_t common = 0, changes = 0, last = 0;
  for (size_t k = 1; k < value.size(); ++k) {
    if (value[k] == value[k - 1]) continue;
    if (changes++ > 0) common = std::gcd(common, k - last);
    last = k;
  }
  return changes < least_changes ? 0 : common;
}

}  // namespace loopwright
