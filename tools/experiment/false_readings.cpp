#include "tools/experiment/false_readings.h"
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include "tools/experiment/signal_figures.h"

namespace loopwright {
namespace {

/// The smallest change from row to row: a count, if the sensor counts.
double least_change(std::span<const double> value) {
  double least = std::numeric_limits<double>::infinity();
  for (size_t k = 1; k < value.size(); ++k)
    if (value[k] != value[k - 1]) least = std::min(least, std::abs(value[k] - value[k - 1]));
  return least;
}

/// [signal a row] Faster, two equal readings are no chance.
double least_speed(std::span<const double> value) {
  constexpr double least_counts = 4, least_deviations = 8;
  std::vector<double> at(value.size());
  std::iota(at.begin(), at.end(), 0.0);
  return std::max(least_counts * least_change(value), least_deviations * noise_of(at, value));
}

/// Rows that repeat the reading before while the signal moves on.
void add_stale(std::span<const double> value, std::vector<size_t>& rows) {
  constexpr double same_speed = 0.3;
  const double least_step = least_speed(value);
  for (size_t k = 2, good = 0; k + 1 < value.size(); ++k) {  // good: the last true reading before k - 1
    if (value[k] != value[k - 1]) {
      good = k - 1;
      continue;
    }
    size_t end = k;
    while (end < value.size() && value[end] == value[k - 1]) ++end;
    if (end == value.size()) return;
    const double speed = (value[k - 1] - value[good]) / double(k - 1 - good);  // per row
    const double caught_up = value[end] - value[k - 1], expected = speed * double(end - k + 1);
    const bool moves_on = std::abs(caught_up - expected) < same_speed * std::abs(expected);
    if (good < k - 1 && moves_on && std::abs(speed) > least_step)
      for (size_t row = k; row < end; ++row) rows.push_back(row);
    good = k - 1, k = end;
  }
}

/// Ascending.
std::vector<size_t> each_once(std::vector<size_t> rows) {
  std::ranges::sort(rows);
  rows.erase(std::ranges::unique(rows).begin(), rows.end());
  return rows;
}

}  // namespace

std::vector<size_t> leaps_out_and_back(std::span<const double> value, double factor) {
  std::vector<size_t> rows;
  constexpr double least_share = 0.25, most_share = 0.75;  // about a half
  const auto second = [&](size_t k) { return value[k + 1] - 2 * value[k] + value[k - 1]; };
  for (const size_t row : outliers(value, factor)) {
    if (row < 2 || row + 2 >= value.size()) continue;
    const auto is_half = [&](size_t k) {
      const double share = -second(k) / second(row);
      return share > least_share && share < most_share;
    };
    if (is_half(row - 1) && is_half(row + 1)) rows.push_back(row);
  }
  return rows;
}

std::vector<size_t> single_zeros(std::span<const double> value) {
  constexpr double least_size = 3;  // [noise of the signal]
  std::vector<double> at(value.size());
  std::iota(at.begin(), at.end(), 0.0);
  const double least = least_size * noise_of(at, value);
  std::vector<size_t> rows;
  for (size_t k = 2; k + 2 < value.size(); ++k) {
    if (value[k] != 0) continue;
    const double side = value[k - 1] < 0 ? -1 : 1;
    const auto is_beyond = [&](size_t row) { return side * value[row] > least; };
    if (is_beyond(k - 2) && is_beyond(k - 1) && is_beyond(k + 1) && is_beyond(k + 2)) rows.push_back(k);
  }
  return rows;
}

std::vector<size_t> false_readings(std::span<const double> value) {
  std::vector<size_t> rows = leaps_out_and_back(value);
  add_stale(value, rows);
  return each_once(std::move(rows));
}

std::vector<size_t> unfelt_rows(std::span<const double> input, InputLeaps leaps) {
  constexpr double near = 5;  // [usual second difference] whether they are felt, the record decides
  if (leaps == InputLeaps::felt) return {};
  if (leaps == InputLeaps::far_unfelt) return leaps_out_and_back(input);
  std::vector<size_t> rows = leaps_out_and_back(input, near);
  std::ranges::copy(single_zeros(input), std::back_inserter(rows));
  return each_once(std::move(rows));
}

void replace_readings(std::span<const double> at, std::span<double> value, std::span<const size_t> rows) {
  const auto is_false = [&](size_t row) { return std::ranges::binary_search(rows, row); };
  for (const size_t row : rows) {
    std::array<size_t, 4> around{};
    size_t found = 0;
    for (size_t k = row; k-- > 0 && found < 2;)
      if (!is_false(k)) around[found++] = k;
    for (size_t k = row + 1; found >= 2 && k < value.size() && found < 4; ++k)
      if (!is_false(k)) around[found++] = k;
    if (found < 4) continue;
    const std::array<double, 4> weights = weights_of_cubic(at, row, around);
    value[row] = 0;
    for (size_t j = 0; j < around.size(); ++j) value[row] += weights[j] * value[around[j]];
  }
}

}  // namespace loopwright
