/// First-order filters in discrete time, the parts of sampled controllers and observers.
///
/// All use Tustin's rule s = (2/T) (z-1)/(z+1). The transform of a product is the product of the transforms,
/// so filters of higher order are cascades of these. Their polynomials, whose coefficients cancel, are never
/// formed.
#pragma once
#include "models/real/real.h"

namespace loopwright {

/// ω/(s+ω). Written as a correction of the last output, so that a constant signal passes unchanged to the
/// last bit.
template <class Real> struct TustinLag {
  Real weight;
  /// `cutoff` in rad/s, `sample_time` in s.
  LW_INLINE static TustinLag of(const Real& cutoff, double sample_time) {
    const Real turn = cutoff * sample_time;
    return {turn / (2.0 + turn)};
  }
  LW_INLINE Real next(const Real& u, const Real& last_u, const Real& last_y) const {
    return last_y + weight * ((u - last_y) + (last_u - last_y));
  }
};

/// ω s/(s+ω): the derivative of a constant signal is exactly zero.
template <class Real> struct TustinDerivative {
  Real keep, slope;
  /// `cutoff` in rad/s, `sample_time` in s.
  LW_INLINE static TustinDerivative of(const Real& cutoff, double sample_time) {
    const Real turn = cutoff * sample_time, scale = 1.0 / (2.0 + turn);
    return {(2.0 - turn) * scale, 2.0 * cutoff * scale};
  }
  LW_INLINE Real next(const Real& u, const Real& last_u, const Real& last_y) const {
    return keep * last_y + slope * (u - last_u);
  }
};

}  // namespace loopwright
