#include "tools/report/thin.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace loopwright::report {
namespace {

constexpr std::size_t samples_per_stretch = 5;

/// What is kept of a stretch: extremes of its finite samples, and its last gap.
struct Extremes {
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::size_t lowest = none, highest = none, gap = none;

  void take_gap(std::size_t i) { gap = i; }
  void take_lowest(std::span<const double> y, std::size_t i) {
    if (lowest == none || y[i] < y[lowest]) lowest = i;
  }
  void take_highest(std::span<const double> y, std::size_t i) {
    if (highest == none || y[i] > y[highest]) highest = i;
  }
  void take(std::span<const double> y, std::size_t i) {
    if (!std::isfinite(y[i])) return take_gap(i);
    take_lowest(y, i), take_highest(y, i);
  }
};

void append(const Extremes& extremes, std::size_t begin, std::size_t end, std::vector<std::size_t>& kept) {
  const auto or_begin = [&](std::size_t i) { return i == Extremes::none ? begin : i; };
  std::size_t chosen[samples_per_stretch] = {begin, or_begin(extremes.lowest), or_begin(extremes.highest),
                                             end - 1, or_begin(extremes.gap)};
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

constexpr std::size_t block_size = 256;  // samples: a stretch looks at most at two of its blocks in detail
constexpr std::uint16_t no_index = std::numeric_limits<std::uint16_t>::max();

}  // namespace

std::vector<std::size_t> thin(std::span<const double> y, std::size_t limit) {
  return thin_part(0, y.size(), limit, [&](std::size_t begin, std::size_t end) {
    Extremes extremes;
    for (std::size_t i = begin; i < end; ++i) extremes.take(y, i);
    return extremes;
  });
}

CurveSummary::CurveSummary(std::span<const double> y) {
  const auto in_block = [](std::size_t i, std::size_t begin) {
    return i == Extremes::none ? no_index : static_cast<std::uint16_t>(i - begin);
  };
  // The last block may be shorter; it is always looked at in detail.
  blocks_.reserve(y.size() / block_size);
  for (std::size_t begin = 0; begin + block_size <= y.size(); begin += block_size) {
    Extremes extremes;
    double sum_of_squares = 0;
    for (std::size_t i = begin; i < begin + block_size; ++i)
      extremes.take(y, i), sum_of_squares += y[i] * y[i];
    blocks_.push_back({sum_of_squares, in_block(extremes.lowest, begin), in_block(extremes.highest, begin),
                       in_block(extremes.gap, begin)});
  }
}

template <class OfBlock, class OfSample>
void CurveSummary::visit(std::size_t begin, std::size_t end, OfBlock&& of_block, OfSample&& of_sample) const {
  const std::size_t first = (begin + block_size - 1) / block_size, last = end / block_size;
  if (first >= last) {
    for (std::size_t i = begin; i < end; ++i) of_sample(i);
    return;
  }
  for (std::size_t i = begin; i < first * block_size; ++i) of_sample(i);
  for (std::size_t b = first; b < last; ++b) of_block(blocks_[b], b * block_size);
  for (std::size_t i = last * block_size; i < end; ++i) of_sample(i);
}

std::vector<std::size_t> CurveSummary::thin(std::span<const double> y, std::size_t first, std::size_t last,
                                            std::size_t limit) const {
  return thin_part(first, last, limit, [&](std::size_t begin, std::size_t end) {
    Extremes extremes;
    visit(
        begin, end,
        [&](const Block& block, std::size_t at) {
          if (block.lowest != no_index)
            extremes.take_lowest(y, at + block.lowest), extremes.take_highest(y, at + block.highest);
          if (block.gap != no_index) extremes.take_gap(at + block.gap);
        },
        [&](std::size_t i) { extremes.take(y, i); });
    return extremes;
  });
}

CurveSummary::Range CurveSummary::range(std::span<const double> y, std::size_t begin, std::size_t end) const {
  Extremes extremes;
  double sum_of_squares = 0;
  visit(
      begin, end,
      [&](const Block& block, std::size_t at) {
        if (block.lowest != no_index)
          extremes.take_lowest(y, at + block.lowest), extremes.take_highest(y, at + block.highest);
        sum_of_squares += block.sum_of_squares;
      },
      [&](std::size_t i) { extremes.take(y, i), sum_of_squares += y[i] * y[i]; });
  const auto value = [&](std::size_t i) {
    return i == Extremes::none ? std::numeric_limits<double>::quiet_NaN() : y[i];
  };
  return {value(extremes.lowest), value(extremes.highest), sum_of_squares};
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
