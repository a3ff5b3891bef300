/// Order statistics.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>
#include "models/real/whole.h"

namespace loopwright {

/// The value of a rank, from 0 for the least.
inline double order_statistic(std::span<const double> values, size_t rank) {
  std::vector<double> ranked(values.begin(), values.end());
  std::ranges::nth_element(ranked, ranked.begin() + std::ptrdiff_t(rank));
  return ranked[rank];
}

/// The value below which a share of the values lies, 0 … 1, by nearest rank; NaN if there are none.
inline double quantile(std::span<const double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double rank = std::round(share * double(values.size() - 1));
  return order_statistic(values, whole_index(rank, values.size()));
}

/// The same by the rank below.
inline double lower_quantile(std::span<const double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  return order_statistic(values, whole_index(share * double(values.size() - 1), values.size()));
}

}  // namespace loopwright
