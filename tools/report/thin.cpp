#include "tools/report/thin.h"
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace loopwright::report {
namespace {

constexpr std::size_t samples_per_stretch = 5;

void append_stretch(std::span<const double> y, std::size_t begin, std::size_t end,
                    std::vector<std::size_t>& kept) {
  std::size_t lowest = begin, highest = begin, gap = end;
  for (std::size_t i = begin; i < end; ++i) {
    if (!std::isfinite(y[i])) {
      gap = i;
      continue;
    }
    // A first sample that is a gap is replaced by any number.
    if (!(y[lowest] <= y[i])) lowest = i;
    if (!(y[highest] >= y[i])) highest = i;
  }
  std::size_t chosen[samples_per_stretch] = {begin, lowest, highest, end - 1, gap == end ? begin : gap};
  std::sort(std::begin(chosen), std::end(chosen));
  kept.insert(kept.end(), std::begin(chosen), std::unique(std::begin(chosen), std::end(chosen)));
}

}  // namespace

std::vector<std::size_t> thin(std::span<const double> y, std::size_t limit) {
  std::vector<std::size_t> kept;
  if (y.size() <= limit) {
    kept.resize(y.size());
    std::iota(kept.begin(), kept.end(), std::size_t{0});
    return kept;
  }
  const std::size_t stretches = std::max<std::size_t>(1, limit / samples_per_stretch);
  kept.reserve(stretches * samples_per_stretch);
  for (std::size_t k = 0; k < stretches; ++k) {
    const std::size_t begin = y.size() * k / stretches, end = y.size() * (k + 1) / stretches;
    if (begin < end) append_stretch(y, begin, end, kept);
  }
  return kept;
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
