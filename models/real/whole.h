/// Whole numbers out of floats. Converting a float that is not finite, or too large, is undefined in C++: the
/// processor gives a number far outside of any list. So every count, index and number of ticks that comes from a
/// float comes through here.
#pragma once
#include <concepts>
#include <cstddef>

namespace loopwright {

/// x without its fraction, kept from `low` to `high`; of a NaN, `low`.
template <std::integral Whole> constexpr Whole whole_between(double x, Whole low, Whole high) {
  if (!(x >= double(low))) return low;
  return x < double(high) ? Whole(x) : high;
}

/// The place of x in a list of `size` items, at least one.
constexpr std::size_t whole_index(double x, std::size_t size) {
  return whole_between<std::size_t>(x, 0, size - 1);
}

/// A count of rows, samples or the like, at most a thousand million: more than any record or list holds.
constexpr std::size_t whole_count(double x) { return whole_between<std::size_t>(x, 0, 1'000'000'000); }

}  // namespace loopwright
