#include "tools/report/thin.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace loopwright::report {
namespace {

constexpr std::size_t samples_per_stretch = 5;

/// What is kept of a stretch: the first ones of the extremes of its finite samples, and its last gap.
struct Extremes {
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::size_t lowest_at = none, highest_at = none, gap_at = none;
  double lowest = std::numeric_limits<double>::quiet_NaN(), highest = lowest;

  void take_lowest(double value, std::size_t i) {
    if (lowest_at == none || value < lowest) lowest = value, lowest_at = i;
  }
  void take_highest(double value, std::size_t i) {
    if (highest_at == none || value > highest) highest = value, highest_at = i;
  }
  void take(double value, std::size_t i) {
    if (!std::isfinite(value)) {
      gap_at = i;
      return;
    }
    take_lowest(value, i), take_highest(value, i);
  }
};

void append(const Extremes& extremes, std::size_t begin, std::size_t end, std::vector<std::size_t>& kept) {
  const auto or_begin = [&](std::size_t i) { return i == Extremes::none ? begin : i; };
  std::size_t chosen[samples_per_stretch] = {
      begin, or_begin(extremes.lowest_at), or_begin(extremes.highest_at), end - 1, or_begin(extremes.gap_at)};
  std::sort(std::begin(chosen), std::end(chosen));
  kept.insert(kept.end(), std::begin(chosen), std::unique(std::begin(chosen), std::end(chosen)));
}

/// Calls extremes_of(begin, end) for each stretch.
template <class ExtremesOf>
std::vector<std::size_t> thin_part(std::size_t first, std::size_t last, std::size_t limit,
                                   ExtremesOf&& extremes_of) {
  std::vector<std::size_t> kept;
  const std::size_t size = last - first;
  if (size <= limit) {
    kept.resize(size);
    std::iota(kept.begin(), kept.end(), first);
    return kept;
  }
  const std::size_t stretches = std::max<std::size_t>(1, limit / samples_per_stretch);
  kept.reserve(stretches * samples_per_stretch);
  for (std::size_t k = 0; k < stretches; ++k) {
    const std::size_t begin = first + size * k / stretches, end = first + size * (k + 1) / stretches;
    if (begin < end) append(extremes_of(begin, end), begin, end, kept);
  }
  return kept;
}

// A part begins and ends with at most a block of samples, and with at most `blocks_of_one` blocks of a level.
constexpr std::size_t shortest_block = 64, blocks_of_one = 16;
constexpr std::uint32_t no_index = std::numeric_limits<std::uint32_t>::max();

/// `offset`: of the block, in the samples that `extremes` are about.
template <class Block> void take_block(const Block& block, std::size_t offset, Extremes& extremes) {
  if (block.lowest_at != no_index) {
    extremes.take_lowest(block.lowest, offset + block.lowest_at);
    extremes.take_highest(block.highest, offset + block.highest_at);
  }
  if (block.gap_at != no_index) extremes.gap_at = offset + block.gap_at;
}

template <class Block> Block block_of(const Extremes& extremes, double sum_of_squares) {
  const auto at = [](std::size_t i) {
    return i == Extremes::none ? no_index : static_cast<std::uint32_t>(i);
  };
  return {sum_of_squares,         extremes.lowest,         extremes.highest,
          at(extremes.lowest_at), at(extremes.highest_at), at(extremes.gap_at)};
}

}  // namespace

std::vector<std::size_t> thin(std::span<const double> y, std::size_t limit) {
  return thin_part(0, y.size(), limit, [&](std::size_t begin, std::size_t end) {
    Extremes extremes;
    for (std::size_t i = begin; i < end; ++i) extremes.take(y[i], i);
    return extremes;
  });
}

CurveSummary::CurveSummary(std::span<const double> y) {
  std::vector<Block> blocks;
  blocks.reserve(y.size() / shortest_block);
  for (std::size_t begin = 0; begin + shortest_block <= y.size(); begin += shortest_block) {
    Extremes extremes;
    double sum_of_squares = 0;
    for (std::size_t i = 0; i < shortest_block; ++i)
      extremes.take(y[begin + i], i), sum_of_squares += y[begin + i] * y[begin + i];
    blocks.push_back(block_of<Block>(extremes, sum_of_squares));
  }
  // Indices in a block of all samples still fit into 32 bits: longer blocks are not made.
  for (std::size_t size = shortest_block; !blocks.empty(); size *= blocks_of_one) {
    levels_.push_back(std::move(blocks));
    blocks.clear();
    if (size > no_index / blocks_of_one) return;
    const std::vector<Block>& parts = levels_.back();
    for (std::size_t first = 0; first + blocks_of_one <= parts.size(); first += blocks_of_one) {
      Extremes extremes;
      double sum_of_squares = 0;
      for (std::size_t b = 0; b < blocks_of_one; ++b)
        take_block(parts[first + b], b * size, extremes), sum_of_squares += parts[first + b].sum_of_squares;
      blocks.push_back(block_of<Block>(extremes, sum_of_squares));
    }
  }
}

template <class OfBlock, class OfSample>
void CurveSummary::visit(std::size_t begin, std::size_t end, OfBlock&& of_block, OfSample&& of_sample) const {
  for (std::size_t at = begin; at < end;) {
    const std::size_t boundary = (at + shortest_block - 1) / shortest_block * shortest_block;
    if (boundary > at || at + shortest_block > end) {
      const std::size_t until = boundary > at ? std::min(boundary, end) : end;
      for (; at < until; ++at) of_sample(at);
      continue;
    }
    // The longest block that begins here and does not reach beyond the end.
    std::size_t level = 0, size = shortest_block;
    while (level + 1 < levels_.size() && at % (size * blocks_of_one) == 0 && at + size * blocks_of_one <= end)
      ++level, size *= blocks_of_one;
    of_block(levels_[level][at / size], at);
    at += size;
  }
}

std::vector<std::size_t> CurveSummary::thin(std::span<const double> y, std::size_t first, std::size_t last,
                                            std::size_t limit) const {
  return thin_part(first, last, limit, [&](std::size_t begin, std::size_t end) {
    Extremes extremes;
    visit(
        begin, end, [&](const Block& block, std::size_t at) { take_block(block, at, extremes); },
        [&](std::size_t i) { extremes.take(y[i], i); });
    return extremes;
  });
}

CurveSummary::Range CurveSummary::range(std::span<const double> y, std::size_t begin, std::size_t end) const {
  Extremes extremes;
  double sum_of_squares = 0;
  visit(
      begin, end,
      [&](const Block& block, std::size_t at) {
        take_block(block, at, extremes), sum_of_squares += block.sum_of_squares;
      },
      [&](std::size_t i) { extremes.take(y[i], i), sum_of_squares += y[i] * y[i]; });
  return {extremes.lowest, extremes.highest, sum_of_squares};
}

std::size_t fair_limit(std::vector<std::size_t> lengths, std::size_t budget) {
  std::sort(lengths.begin(), lengths.end());
  std::size_t remaining = lengths.size();
  for (const std::size_t length : lengths) {
    if (length > budget / remaining) return budget / remaining;
    budget -= length;  // a short list leaves its unused share to the longer ones
    --remaining;
  }
  return std::numeric_limits<std::size_t>::max();
}

}  // namespace loopwright::report
