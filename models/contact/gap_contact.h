/// Two elastic stops with damping and free travel between them. The stops push and never pull.
///
/// At the high stop F = max(0, k (x - high) + c v), at the low stop F = min(0, k (x - low) + c v), else 0. F
/// is positive at the high stop: subtract it from the driving force. Damping makes F jump at first contact.
#pragma once
#include "models/real/real.h"

namespace loopwright {

template <Scalar Real> struct GapContact {
  Real low, high;           ///< positions of the stops
  Real stiffness, damping;  ///< of each stop
  Real softness;            ///< 1 / stiffness

  /// 1 at the high stop, -1 at the low stop, 0 between them. Contact means that the stop is touched and
  /// presses.
  LW_INLINE Real side(const Real& position, const Real& velocity) const {
    const Real at_low = select(low_pressing(position, velocity) >= 0.0, Real(-1.0), Real(0.0));
    return select(high_pressing(position, velocity) >= 0.0, Real(1.0), at_low);
  }
  /// The force of the stop on this side.
  LW_INLINE Real force(const Real& side, const Real& position, const Real& velocity) const {
    const Real brake = damping * velocity;
    const Real at_high = maximum(stiffness * (position - high) + brake, Real(0.0));
    const Real at_low = minimum(stiffness * (position - low) + brake, Real(0.0));
    return select(side > 0.0, at_high, select(side < 0.0, at_low, Real(0.0)));
  }
  /// A length. It rises through zero when the high stop is reached and falls through zero when it is left.
  LW_INLINE Real high_pressing(const Real& position, const Real& velocity) const {
    return (position - high) + minimum(damping * softness * velocity, Real(0.0));
  }
  /// The same for the low stop.
  LW_INLINE Real low_pressing(const Real& position, const Real& velocity) const {
    return (low - position) + minimum(-damping * softness * velocity, Real(0.0));
  }
};

}  // namespace loopwright
