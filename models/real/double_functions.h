/// Elementary functions of one double that functions.h does not have, for formulas and for precomputation
/// before a run. They too are bit-identical on every processor, unlike those of libm. Errors are the largest
/// observed, in units in the last place (ulp); the tests enforce the bounds. NaN gives NaN; outside its
/// domain a function is NaN.
#pragma once
#include <cmath>
#include "models/real/functions.h"

namespace loopwright {

/// tan x, x in rad. Error ≤ 4 ulp.
inline double tangent(double x) { return sine(x) / cosine(x); }

/// asin x in rad. Error ≤ 3 ulp.
inline double arc_sine(double x) {
  return std::fabs(x) <= 1 ? arc_tangent2(x, std::sqrt((1 - x) * (1 + x))) : std::nan("");
}
/// acos x in rad. Error ≤ 3 ulp.
inline double arc_cosine(double x) {
  return std::fabs(x) <= 1 ? arc_tangent2(std::sqrt((1 - x) * (1 + x)), x) : std::nan("");
}

/// eˣ - 1, accurate also for small x. Error ≤ 2 ulp.
inline double exponential_less_one(double x) {
  if (!(std::fabs(x) < 40)) return exponential(x) - 1;
  const double n = detail::nearest_integer(x * detail::per_ln2);
  const double high = x - n * detail::ln2_high, low = n * detail::ln2_low;
  const double r = high - low, lost = (high - r) - low;
  const double small = r + (r * r * detail::polynomial<detail::exponential_series>(r) + lost);
  const double scale = power_of_two(n);
  return scale * small + (scale - 1);
}
/// ln(1 + x), accurate also for small x. Error ≤ 3 ulp.
inline double logarithm_of_one_plus(double x) {
  const double sum = 1 + x;
  if (sum == 1 || !(std::fabs(sum) < detail::infinity)) return sum == 1 ? x : natural_logarithm(sum);
  return natural_logarithm(sum) * (x / (sum - 1));  // cancels the rounding error of the sum
}

/// sinh x. Error ≤ 3 ulp.
inline double hyperbolic_sine(double x) {
  const double magnitude = std::fabs(x);
  double y;
  if (magnitude < 22) {
    const double growth = exponential_less_one(magnitude);
    y = 0.5 * (growth + growth / (growth + 1));
  } else {
    const double root = exponential(0.5 * magnitude);
    y = 0.5 * root * root;
  }
  return std::copysign(y, x);
}
/// cosh x. Error ≤ 4 ulp.
inline double hyperbolic_cosine(double x) {
  const double root = exponential(0.5 * std::fabs(x)), growth = root * root;
  return 0.5 * root * root + 0.5 / growth;
}
/// arsinh x. Error ≤ 3 ulp.
inline double area_sine(double x) {
  const double magnitude = std::fabs(x);
  if (magnitude > 1e8) return std::copysign(natural_logarithm(magnitude) + 0x1.62e42fefa39efp-1, x);
  const double square = magnitude * magnitude;
  return std::copysign(logarithm_of_one_plus(magnitude + square / (1 + std::sqrt(1 + square))), x);
}
/// arcosh x. Error ≤ 3 ulp.
inline double area_cosine(double x) {
  if (x > 1e8) return natural_logarithm(x) + 0x1.62e42fefa39efp-1;
  const double above = x - 1;
  return x >= 1 ? logarithm_of_one_plus(above + std::sqrt(2 * above + above * above)) : std::nan("");
}
/// artanh x. Error ≤ 3 ulp.
inline double area_tangent(double x) {
  const double magnitude = std::fabs(x);
  return std::copysign(0.5 * logarithm_of_one_plus(2 * magnitude / (1 - magnitude)), x);
}

namespace detail {
/// ln x / ln b; the reciprocal of ln b is given in two parts. Integer powers of b give integers.
inline double logarithm_to_base(double x, double per_high, double per_low) {
  if (!(x > 0 && x < infinity) || x == 1) return natural_logarithm(x);
  const auto logarithm = precise_logarithm(x);
  const auto product = exact_product(logarithm.high, per_high);
  return product.high + (product.low + (logarithm.high * per_low + logarithm.low * per_high));
}
}  // namespace detail

/// log₂ x. Error ≤ 1 ulp.
inline double binary_logarithm(double x) {
  return detail::logarithm_to_base(x, 0x1.71547652b82fep0, 0x1.777d0ffda0d24p-56);
}
/// log₁₀ x. Error ≤ 1 ulp.
inline double decimal_logarithm(double x) {
  return detail::logarithm_to_base(x, 0x1.bcb7b1526e50ep-2, 0x1.95355baaafad3p-57);
}

namespace detail {
/// xⁿ by squaring in double-double precision; not valid where that overflows.
inline double whole_power(double x, int n) {
  const auto times = [](const Pair<double>& a, const Pair<double>& b) {
    const auto product = exact_product(a.high, b.high);
    return exact_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
  };
  Pair<double> result{1, 0}, square{x, 0};
  for (int left = n < 0 ? -n : n; left > 0; left /= 2) {
    if (left % 2 == 1) result = times(result, square);
    if (left > 1) square = times(square, square);
  }
  if (n > 0) return result.high;
  const double inverse = 1 / result.high;
  const auto back = exact_product(inverse, result.high);
  return inverse + inverse * (((1 - back.high) - back.low) - inverse * result.low);
}
}  // namespace detail

/// xʸ as in formulas: also for negative x if y is an integer; 1 for y = 0. Correctly rounded for y = ½ and,
/// far from overflow, for integer y up to 64; otherwise as power().
inline double any_power(double x, double y) {
  if (y == 0) return 1;
  if (y == 2) return x * x;
  if (y == 0.5) return std::sqrt(x);
  const bool is_whole = y == std::rint(y);
  if (x < 0 && !is_whole) return std::nan("");
  if (is_whole && std::fabs(y) <= 64) {
    const double product = detail::whole_power(x, int(y));
    if (std::fabs(product) > 1e-280 && std::fabs(product) < 1e280) return product;
  }
  const double magnitude = power(std::fabs(x), y);
  return x < 0 && std::fmod(y, 2) != 0 ? -magnitude : magnitude;
}

}  // namespace loopwright
