/// Derivatives of functions that can only be evaluated, good to nearly all digits.
#pragma once
#include <functional>
#include <span>
#include <vector>

namespace loopwright {

/// Writes f(x) to `value`; false where there is no value.
using FunctionOfNumber = std::function<bool(double x, std::span<double> value)>;

struct Slope {
  std::vector<double> value;  ///< df/dx, an element for each of f
  std::vector<double> error;  ///< estimate of what is wrong with it at most
  std::vector<double> size;   ///< greatest slope between x and any point that was looked at
  /// For elements with a corner at x, such as |x| at 0, slope on the left and on the right; their mean is
  /// `value`. Equal, to within the error, for elements without.
  std::vector<double> left, right;
  bool has_corner(size_t element) const { return left[element] != right[element]; }
};

/// df/dx of `size` functions at x by central differences at steps from 0.7 max(|x|, 1) down over twelve
/// decades, extrapolated to step 0 (L. F. Richardson). Of all the estimates the one is taken that agrees best
/// with its two neighbours, its rounding error included, so no scale need be known: straight lines come out
/// to the last bits, analytic functions to about 1e-11. Where f has no value at all around x the slope is
/// NaN.
Slope slope(const FunctionOfNumber& f, double x, size_t size);

}  // namespace loopwright
