/// d = x_motor - x_load;  F = k (d ∓ gap/2) + c d' beyond the gap, pushing only; 0 inside
#include "blocks/math/sides.h"
#include "models/contact/gap_contact.h"

namespace loopwright::blocks {

/// Physical backlash: two masses, each a block of its own, that touch after a gap. Subtract the force at the
/// motor and add it at the load. Contact and separation are events for variable-step solvers.
template <class Real> struct BacklashCoupling {
  Real gap, stiffness, damping = 0.0;
  GapContact<Real> contact;
  struct In {
    Real motor_position, motor_velocity, load_position, load_velocity;
  };
  struct Out {
    Real force;
  };
  struct Mode {
    Real side;
  };
  struct Crossings {
    Real backward, forward;
  };
  static constexpr bool decides_anew = true;
  static constexpr auto describe() {
    return block(
        "Couples a motor and a load through a gap with elastic contact.",
        parameter(&BacklashCoupling::gap, "gap", "$position", "Free travel between the two contacts")
            .not_negative(),
        parameter(&BacklashCoupling::stiffness, "stiffness", "$force/$position", "Force per indentation")
            .positive(),
        parameter(&BacklashCoupling::damping, "damping", "$force*s/$position",
                  "Force per speed while in contact")
            .not_negative()
            .optional(),
        input(&In::motor_position, "motor_position", "$position", "Position of the driving part"),
        input(&In::motor_velocity, "motor_velocity", "$position/s", "Its velocity"),
        input(&In::load_position, "load_position", "$position", "Position of the driven part"),
        input(&In::load_velocity, "load_velocity", "$position/s", "Its velocity"),
        output(&Out::force, "force", "$force", "Force that drives the load; subtract it at the motor"),
        crossing(&Crossings::backward, "backward contact"), crossing(&Crossings::forward, "forward contact"));
  }
  void prepare(double) { contact = {-0.5 * gap, 0.5 * gap, stiffness, damping, 1.0 / stiffness}; }
  Fault decide(const In& in, Mode& mode) const {
    mode.side = contact.side(deflection(in), approach(in));
    return fault_if_nan(deflection(in), approach(in));
  }
  void outputs(const In& in, const Mode& mode, Out& out) const {
    out.force = contact.force(mode.side, deflection(in), approach(in));
  }
  void crossings(const In& in, Crossings& value) const {
    value.backward = not_below_zero(contact.low_pressing(deflection(in), approach(in)));
    value.forward = not_below_zero(contact.high_pressing(deflection(in), approach(in)));
  }
  static Real deflection(const In& in) { return in.motor_position - in.load_position; }
  static Real approach(const In& in) { return in.motor_velocity - in.load_velocity; }
};
LOOPWRIGHT_BLOCK(BacklashCoupling)

}  // namespace loopwright::blocks
