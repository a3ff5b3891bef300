/// Dry friction that really holds: which way the parts slide, and what force holds them while they stick.
///
/// Three pieces, held while a solver integrates: sliding forward (direction 1), sliding backward (-1), stuck
/// (0). A piece ends where `margin` falls through zero: sliding, when the velocity comes to zero; stuck, when
/// the force to be held passes the breakaway force. At zero velocity the parts stick unless they are pushed
/// harder than that; no velocity has to be guessed at which "zero" begins, and there is nothing that could
/// chatter.
///
/// While stuck, friction takes up the other forces and in addition settling·v, at most the breakaway force:
/// the velocity that is left over from the last step decays with time constant mass/settling instead of a
/// drift for ever. Karnopp (1985), "Computer Simulation of Stick-Slip Friction", has the same pieces with a
/// band of velocities.
#pragma once
#include "models/real/real.h"

namespace loopwright {

template <Scalar Real> struct Stiction {
  Real forward, backward;  ///< forces that start a motion forward and backward, both ≥ 0
  Real settling;           ///< force per velocity while stuck: moving mass / settling time

  /// The friction force while stuck; `applied` is the sum of the other forces.
  LW_INLINE Real holding_force(const Real& velocity, const Real& applied) const {
    return minimum(maximum(applied + settling * velocity, -backward), forward);
  }
  /// Which way the parts slide from now on: 1, -1, or 0 when stuck.
  LW_INLINE Real next_direction(const Real& direction, const Real& velocity, const Real& applied) const {
    const Real carried = breaks_away(settling * velocity);  // too fast to be caught
    const Real at_rest = select(carried == 0.0, breaks_away(applied), carried);
    return select(direction * velocity > 0.0, direction, at_rest);
  }
  /// Positive inside a piece; falls through zero where it ends.
  LW_INLINE Real margin(const Real& direction, const Real& velocity, const Real& applied) const {
    const Real carried = settling * velocity;
    const Real held = minimum(forward - maximum(applied, carried), backward + minimum(applied, carried));
    return select(direction == 0.0, held, direction * velocity);
  }

 private:
  LW_INLINE Real breaks_away(const Real& force) const {
    const Real back = select((force <= -backward) & (force < 0.0), Real(-1.0), Real(0.0));
    return select((force >= forward) & (force > 0.0), Real(1.0), back);
  }
};

}  // namespace loopwright
