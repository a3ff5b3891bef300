/// The controllable canonical form of a transfer function, with its time scaled.
///
/// With s = ω p the states z_i = p^i / (pⁿ + Σ â_i p^i) U have the magnitude of the input for any unit of
/// time. Without scaling, the lowest state of 1/(s/1000 + 1)⁴ would be 10¹² times smaller than the input, far
/// below the absolute tolerance of a solver. ω is a power of two near the geometric mean of the poles, so the
/// scaling does not round.
#pragma once
#include <span>
#include <vector>
#include "models/real/real.h"

namespace loopwright {

template <class Real> struct CanonicalForm {
  Real speed;                          ///< ω, 1/s
  std::vector<Real> feedback, output;  ///< â_i; weights of z_i in the output
  Real direct;                         ///< limit of the transfer function for s → ∞

  /// Coefficients in descending powers of s. denominator[0] ≠ 0; the denominator has at least two
  /// coefficients, the numerator no more than the denominator.
  static CanonicalForm of(const std::vector<Real>& numerator, const std::vector<Real>& denominator) {
    const size_t n = denominator.size() - 1;
    CanonicalForm form{Real(1.0), std::vector<Real>(n), std::vector<Real>(n), Real(0.0)};
    const auto size_of = [](const Real& x) { return exponent(maximum(absolute(x), Real(1e-300))); };
    // The lowest nonzero coefficient divided by the highest is the product of the nonzero poles.
    Real found = 0.0, power = 0.0;
    for (size_t i = n; i > 0; --i) {
      const Real mean = (size_of(denominator[i]) - size_of(denominator[0])) / double(i);
      const auto lowest = (denominator[i] != 0.0) & (found == 0.0);
      power = select(lowest, mean, power);
      found = select(lowest, Real(1.0), found);
    }
    const double limit = 1000.0 / double(n);
    form.speed = power_of_two(round_even(minimum(maximum(power, Real(-limit)), Real(limit))));
    if (numerator.size() == n + 1) form.direct = numerator[0] / denominator[0];
    Real scale = 1.0;
    for (size_t i = n; i-- > 0;) {  // z_i belongs to the i-th power, which has index n - i in the lists
      scale = scale / form.speed;
      form.feedback[i] = denominator[n - i] / denominator[0] * scale;
      const Real weight =
          numerator.size() > i ? numerator[numerator.size() - 1 - i] / denominator[0] * scale : Real(0.0);
      form.output[i] = weight - form.direct * form.feedback[i];
    }
    return form;
  }
  Real outputs(std::span<const Real> z) const {
    Real y = 0.0;
    for (size_t i = 0; i < z.size(); ++i) y = y + output[i] * z[i];
    return y;
  }
  void rates(const Real& u, std::span<const Real> z, std::span<Real> rate) const {
    Real top = u;
    for (size_t i = 0; i < z.size(); ++i) top = top - feedback[i] * z[i];
    for (size_t i = 0; i + 1 < z.size(); ++i) rate[i] = speed * z[i + 1];
    rate[z.size() - 1] = speed * top;
  }
};

}  // namespace loopwright
