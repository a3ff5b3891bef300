/// Reduces the points of a curve without changing its picture.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace loopwright::report {

/// Increasing indices of at most max(limit, 5) samples that draw the same curve as all of y: in each of
/// several equal intervals the first, lowest, highest and last sample, and a non-finite one if there is any,
/// so that gaps stay gaps. All indices when y is short enough. Source: Jugel et al., M4: A
/// visualization-oriented time series data aggregation, PVLDB 7 (2014) 797.
std::vector<std::size_t> thin(std::span<const double> y, std::size_t limit);

/// The largest number n such that lists of these lengths, cut to n each, contain at most `budget` entries
/// together.
std::size_t fair_limit(std::vector<std::size_t> lengths, std::size_t budget);

}  // namespace loopwright::report
