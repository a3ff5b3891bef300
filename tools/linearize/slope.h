/// Derivatives of functions that can only be evaluated, accurate to nearly all digits.
#pragma once
#include <functional>
#include <span>
#include <vector>

namespace loopwright {

/// Writes f(x) to `value`; false if there is no value.
using FunctionOfNumber = std::function<bool(double x, std::span<double> value)>;

struct Slope {
  std::vector<double> value;  ///< df/dx, one element for each of f
  std::vector<double> error;  ///< estimated upper bound of its error
  std::vector<double> size;   ///< largest slope between x and any evaluated point
  /// For elements with a corner at x, such as |x| at 0, slope on the left and on the right; their mean is
  /// `value`. For elements without a corner they are equal to within the error.
  std::vector<double> left, right;
  bool has_corner(size_t element) const { return left[element] != right[element]; }
};

/// df/dx of `size` functions at x by central differences at steps from 0.7 max(|x|, 1) down over twelve
/// decades, extrapolated to step 0 (L. F. Richardson). The estimate is chosen that agrees best with its two
/// neighbors, including its rounding error, so no scale need be known: linear functions are accurate to the
/// last bits, analytic functions to about 1e-11. If f has no value at all around x, the slope is NaN.
Slope slope(const FunctionOfNumber& f, double x, size_t size);

}  // namespace loopwright
