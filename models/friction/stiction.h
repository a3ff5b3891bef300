/// Dry friction with true sticking: the direction of sliding, and the force that holds the parts while they
/// stick.
///
/// There are three modes, constant during integration: sliding forward (direction 1), sliding backward (-1),
/// stuck (0). A mode ends where `margin` falls through zero. Sliding ends when the velocity reaches zero.
/// Sticking ends when the force to be held exceeds the breakaway force. At zero velocity the parts stick
/// unless they are pushed harder than that. The law needs no velocity threshold and does not chatter.
///
/// While stuck, friction balances the other forces and adds settling·v, in total at most the breakaway force.
/// The velocity that remains from the last step therefore decays with time constant mass/settling, so that
/// there is no lasting drift. Karnopp (1985), "Computer Simulation of Stick-Slip Friction", uses the same
/// modes with a velocity band.
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
  /// The direction of sliding from now on: 1, -1, or 0 when stuck.
  LW_INLINE Real next_direction(const Real& direction, const Real& velocity, const Real& applied) const {
    const Real carried = breaks_away(settling * velocity);  // too fast to be held
    const Real at_rest = select(carried == 0.0, breaks_away(applied), carried);
    return select(direction * velocity > 0.0, direction, at_rest);
  }
  /// Positive inside a mode; falls through zero at its end. Parts that have just broken away slide by
  /// `next_direction` for as long as they are pushed hard enough: their velocity says nothing yet.
  LW_INLINE Real margin(const Real& direction, const Real& velocity, const Real& applied) const {
    const Real carried = settling * velocity;
    const Real held = minimum(forward - maximum(applied, carried), backward + minimum(applied, carried));
    const Real pushed = direction * applied - select(direction > 0.0, forward, backward);
    const Real way = direction * velocity;
    const auto is_pushed = (way <= 0.0) & (next_direction(direction, velocity, applied) == direction);
    return select(direction == 0.0, held, select(is_pushed, pushed, way));
  }

 private:
  LW_INLINE Real breaks_away(const Real& force) const {
    const Real back = select((force <= -backward) & (force < 0.0), Real(-1.0), Real(0.0));
    return select((force >= forward) & (force > 0.0), Real(1.0), back);
  }
};

}  // namespace loopwright
