#include "tools/experiment/slower_rows.h"
#include <algorithm>
#include <cmath>
#include <numeric>

namespace loopwright {

SlowerRows rows_with_numbers(std::span<const double> value) {
  constexpr size_t fewest = 5;  // fewer show no rate
  const auto next = [&](size_t row) {
    while (row < value.size() && std::isnan(value[row])) ++row;
    return row;
  };
  const size_t first = next(0), second = next(first + 1);
  const size_t every = second - first;
  if (first + (fewest - 1) * every >= value.size()) return {};
  for (size_t row = 0; row < value.size(); ++row)
    if (std::isnan(value[row]) == (row % every == first % every)) return {};
  return {first, every};
}

SlowerRows rows_of(const Column& column) {
  return column.holes.count > 0 ? rows_with_numbers(column.values) : SlowerRows{};
}

std::vector<double> picked(const SlowerRows& rows, const std::vector<double>& values) {
  if (rows.are_all()) return values;
  std::vector<double> some;
  for (size_t row = rows.first; row < values.size(); row += rows.every) some.push_back(values[row]);
  return some;
}

std::vector<double> means_from(const SlowerRows& rows, const std::vector<double>& values) {
  if (rows.are_all()) return values;
  std::vector<double> means;
  for (size_t row = rows.first; row < values.size(); row += rows.every) {
    const size_t end = std::min(row + rows.every, values.size());
    means.push_back(std::accumulate(&values[row], values.data() + end, 0.0) / double(end - row));
  }
  return means;
}

}  // namespace loopwright
