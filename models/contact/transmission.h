/// A gear, screw or belt: an elastic contact between the input's travel, reduced, and the output.
#pragma once
#include "models/contact/gap_contact.h"
#include "models/real/functions.h"

namespace loopwright {

/// With the travel r of the output for each travel of the input, d = r x_in - x_out presses on the stops of
/// the contact with the force F, which drives the output. The input has to give r F (1 + loss): with the
/// efficiency η that is r F/η while F drives the output (F v > 0), and r F η' while the output drives it, η'
/// the efficiency backwards. The two are joined over the velocity `transition` of the output, by tanh(v /
/// transition).
template <Scalar Real> struct Transmission {
  Real travel, mean, half, per_transition;
  GapContact<Real> contact;

  /// `backwards` at 0: as `efficiency`. `transition` may be 0 if both are 1.
  static Transmission of(const Real& travel, const Real& efficiency, const Real& backwards,
                         const Real& transition, const Real& gap, const Real& stiffness,
                         const Real& damping) {
    const Real driving = 1.0 / efficiency, driven = select(backwards > 0.0, backwards, efficiency);
    return {travel,
            0.5 * (driving + driven),
            0.5 * (driving - driven),
            select(transition > 0.0, 1.0 / transition, Real(0.0)),
            {-0.5 * gap, 0.5 * gap, stiffness, damping, 1.0 / stiffness}};
  }
  LW_INLINE Real side(const Real& deflection, const Real& approach) const {
    return contact.side(deflection, approach);
  }
  /// Without a gap both stops hold at once: a spring and a damper.
  LW_INLINE Real force(const Real& side, const Real& deflection, const Real& approach) const {
    const Real always = contact.stiffness * deflection + contact.damping * approach;
    return select(contact.high > contact.low, contact.force(side, deflection, approach), always);
  }
  /// What the input has to give; `velocity` of the output.
  LW_INLINE Real at_input(const Real& force, const Real& velocity) const {
    return travel * (mean * force + half * absolute(force) * hyperbolic_tangent(velocity * per_transition));
  }
};

}  // namespace loopwright
