/// d = lead θ / 2π - x;  F = k (d ∓ gap/2) + c d' beyond the gap, pushing only, 0 inside; without a gap k d +
/// c d'
///
/// M = F lead / (2π η) while the screw drives, F η' lead / 2π while the nut drives, joined by
/// tanh(v / transition) around rest. The screw's inertia is an `Inertia`, the table a `Mass`. The efficiency
/// backwards of a screw is near 2 - 1/η. Contact and separation are events for variable-step solvers.
#include "blocks/math/sides.h"
#include "blocks/mechanics/transmission_check.h"
#include "models/contact/transmission.h"

namespace loopwright::blocks {

template <class Real> struct BallScrew {
  Real lead, stiffness, efficiency = 1.0, backwards = 0.0, transition = 0.0, gap = 0.0, damping = 0.0;
  Transmission<Real> transmission;
  struct In {
    Real angle, angular_velocity, position, velocity;
  };
  struct Out {
    Real force, torque;
  };
  struct Mode {
    Real side;
  };
  struct Crossings {
    Real backward, forward;
  };
  static constexpr auto describe() {
    using T = BallScrew;
    return block(
        "A ball screw that turns a rotation into a straight motion.",
        parameter(&T::lead, "lead", "m", "Travel of the nut for one turn; negative: a left-hand screw"),
        parameter(&T::stiffness, "stiffness", "N/m", "Stiffness of screw, nut and bearings together")
            .positive(),
        parameter(&T::damping, "damping", "N*s/m", "Damping of the same").not_negative().optional(),
        parameter(&T::gap, "gap", "m", "Free travel of the output between the flanks")
            .not_negative()
            .optional(),
        parameter(&T::efficiency, "efficiency", "", "Power at the output for each power at the input")
            .between(0, 1)
            .optional(),
        parameter(&T::backwards, "backwards_efficiency", "", "When the load drives; 0: as efficiency")
            .between(0, 1)
            .optional(),
        parameter(&T::transition, "transition", "m/s",
                  "Width in the output's velocity over which losses change sign")
            .not_negative()
            .optional(),
        input(&In::angle, "angle", "rad", "Angle of the screw"),
        input(&In::angular_velocity, "angular_velocity", "rad/s", "Its velocity"),
        input(&In::position, "position", "m", "Position of the nut"),
        input(&In::velocity, "velocity", "m/s", "Its velocity"),
        output(&Out::force, "force", "N", "Force that drives the table"),
        output(&Out::torque, "torque", "N*m", "Torque that the screw takes; subtract it at the motor"),
        crossing(&Crossings::backward, "backward contact"), crossing(&Crossings::forward, "forward contact"));
  }
  bool may_cross() const { return any(gap > 0.0); }
  void check(const Checker& checker) const {
    check_losses(checker, efficiency, backwards, transition);
    if (lead == 0) checker.error("lead", "the lead is zero");
  }
  void prepare(double) {
    transmission =
        Transmission<Real>::of(lead * (0.5 / pi), efficiency, backwards, transition, gap, stiffness, damping);
  }
  Fault decide(const In& in, Mode& mode) const {
    mode.side = transmission.side(deflection(in), approach(in));
    return fault_if_nan(deflection(in), approach(in));
  }
  void outputs(const In& in, const Mode& mode, Out& out) const {
    out.force = transmission.force(mode.side, deflection(in), approach(in));
    out.torque = transmission.at_input(out.force, in.velocity);
  }
  void crossings(const In& in, Crossings& value) const {
    value.backward = not_below_zero(transmission.contact.low_pressing(deflection(in), approach(in)));
    value.forward = not_below_zero(transmission.contact.high_pressing(deflection(in), approach(in)));
  }

 private:
  Real deflection(const In& in) const { return transmission.travel * in.angle - in.position; }
  Real approach(const In& in) const { return transmission.travel * in.angular_velocity - in.velocity; }
};
LOOPWRIGHT_BLOCK(BallScrew)

}  // namespace loopwright::blocks
