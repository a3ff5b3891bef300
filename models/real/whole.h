/// Floating-point numbers to integers. In C++ the conversion of a number that is not finite or too large is
/// undefined; the processor then gives a value far outside of any list. Every count, index and number of
/// ticks that comes from a floating-point number is therefore converted here.
#pragma once
#include <concepts>
#include <cstddef>

namespace loopwright {

/// x without its fraction, limited to [low, high]; `low` for NaN.
template <std::integral Whole> constexpr Whole whole_between(double x, Whole low, Whole high) {
  if (!(x >= double(low))) return low;
  return x < double(high) ? Whole(x) : high;
}

/// The index of x in a list of `size` items, at least one.
constexpr std::size_t whole_index(double x, std::size_t size) {
  return whole_between<std::size_t>(x, 0, size - 1);
}

/// A number of rows, samples or the like, at most a thousand million: more than any record or list can have.
constexpr std::size_t whole_count(double x) { return whole_between<std::size_t>(x, 0, 1'000'000'000); }

}  // namespace loopwright
