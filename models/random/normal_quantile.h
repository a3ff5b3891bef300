/// Uniform to normal random numbers, bit-identical on every processor.
#pragma once
#include <cmath>
#include "models/real/functions.h"

namespace loopwright {
namespace detail {
/// (above[0] + above[1] x + …)/(1 + below[0] x + …)
inline double quotient(const double (&above)[8], const double (&below)[7], double x) {
  double numerator = above[7], denominator = below[6];
  for (int i = 6; i >= 0; --i) numerator = numerator * x + above[i];
  for (int i = 5; i >= 0; --i) denominator = denominator * x + below[i];
  return numerator / (denominator * x + 1);
}
}  // namespace detail

/// The quantile of the standard normal distribution for probability p, 0 < p < 1; relative error 1e-15 (M. J.
/// Wichura, Algorithm AS 241: The percentage points of the normal distribution, Applied Statistics 37, 1988).
inline double normal_quantile(double p) {
  static constexpr double middle_above[] = {
      3.3871328727963666080e0, 1.3314166789178437745e2, 1.9715909503065514427e3, 1.3731693765509461125e4,
      4.5921953931549871457e4, 6.7265770927008700853e4, 3.3430575583588128105e4, 2.5090809287301226727e3};
  static constexpr double middle_below[] = {
      4.2313330701600911252e1, 6.8718700749205790830e2, 5.3941960214247511077e3, 2.1213794301586595867e4,
      3.9307895800092710610e4, 2.8729085735721942674e4, 5.2264952788528545610e3};
  static constexpr double tail_above[] = {1.42343711074968357734e0,  4.63033784615654529590e0,
                                          5.76949722146069140550e0,  3.64784832476320460504e0,
                                          1.27045825245236838258e0,  2.41780725177450611770e-1,
                                          2.27238449892691845833e-2, 7.74545014278341407640e-4};
  static constexpr double tail_below[] = {2.05319162663775882187e0,  1.67638483018380384940e0,
                                          6.89767334985100004550e-1, 1.48103976427480074590e-1,
                                          1.51986665636164571966e-2, 5.47593808499534494600e-4,
                                          1.05075007164441684324e-9};
  static constexpr double far_above[] = {6.65790464350110377720e0,  5.46378491116411436990e0,
                                         1.78482653991729133580e0,  2.96560571828504891230e-1,
                                         2.65321895265761230930e-2, 1.24266094738807843860e-3,
                                         2.71155556874348757815e-5, 2.01033439929228813265e-7};
  static constexpr double far_below[] = {5.99832206555887937690e-1, 1.36929880922735805310e-1,
                                         1.48753612908506148525e-2, 7.86869131145613259100e-4,
                                         1.84631831751005468180e-5, 1.42151175831644588870e-7,
                                         2.04426310338993978564e-15};
  const double from_middle = p - 0.5;
  if (std::fabs(from_middle) <= 0.425)
    return from_middle * detail::quotient(middle_above, middle_below, 0.180625 - from_middle * from_middle);
  const double r = std::sqrt(-natural_logarithm(from_middle < 0 ? p : 1 - p));
  const double y = r <= 5 ? detail::quotient(tail_above, tail_below, r - 1.6)
                          : detail::quotient(far_above, far_below, r - 5);
  return from_middle < 0 ? -y : y;
}

}  // namespace loopwright
