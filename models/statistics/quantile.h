/// Order statistics.
#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>
#include "models/real/whole.h"

namespace loopwright {

/// The value below which a share of the values lies, 0 … 1, by nearest rank; NaN if there are none.
inline double quantile(std::span<const double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::vector<double> ranked(values.begin(), values.end());
  const size_t rank = whole_index(std::round(share * double(ranked.size() - 1)), ranked.size());
  std::ranges::nth_element(ranked, ranked.begin() + std::ptrdiff_t(rank));
  return ranked[rank];
}

}  // namespace loopwright
