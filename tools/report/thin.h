/// Reduces the points of a curve without changing its picture.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace loopwright::report {

/// Increasing indices of at most max(limit, 5) samples that draw the same curve as all of y: in each of
/// several equal intervals the first, lowest, highest and last sample, and a non-finite one if there is any,
/// so that gaps stay gaps. All indices when y is short enough. Source: Jugel et al., M4: A
/// visualization-oriented time series data aggregation, PVLDB 7 (2014) 797.
std::vector<std::size_t> thin(std::span<const double> y, std::size_t limit);

/// The extremes of short stretches of a curve, of longer ones made of these, and so on, so that any part of
/// the curve is thinned by a look at few of its samples, however many it has. 8 % of the memory of the curve.
class CurveSummary {
 public:
  explicit CurveSummary(std::span<const double> y);

  /// As `thin` of the samples from `begin` to `end` of the same y; indices of y.
  std::vector<std::size_t> thin(std::span<const double> y, std::size_t begin, std::size_t end,
                                std::size_t limit) const;
  /// Of the samples from `begin` to `end`; extremes are those of finite ones, sums of all.
  struct Range {
    double lowest, highest;  ///< NaN if none is finite
    double sum_of_squares;
  };
  Range range(std::span<const double> y, std::size_t begin, std::size_t end) const;

 private:
  /// The values stand beside their indices: what is far apart in memory is not looked at.
  struct Block {
    double sum_of_squares, lowest, highest;
    std::uint32_t lowest_at, highest_at, gap_at;  ///< from the begin of the block; `no_index`: there is none
  };
  template <class OfBlock, class OfSample>
  void visit(std::size_t begin, std::size_t end, OfBlock&& of_block, OfSample&& of_sample) const;
  std::vector<std::vector<Block>> levels_;  ///< shortest blocks first; complete ones only
};

/// The largest number n such that lists of these lengths, cut to n each, contain at most `budget` entries
/// together.
std::size_t fair_limit(std::vector<std::size_t> lengths, std::size_t budget);

}  // namespace loopwright::report
