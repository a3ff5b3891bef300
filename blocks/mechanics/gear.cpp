/// d = θ_in / ratio - θ_out;  M_out = k (d ∓ gap/2) + c d' beyond the gap, pushing only, 0 inside; without a
/// gap k d + c d'
///
/// M_in = M_out / (ratio η) while the input drives, M_out η' / ratio while the load drives, joined by
/// tanh(ω_out / transition) around rest. A part of the ends, of inertia J, is an `Inertia` of its own.
/// Contact and separation are events for variable-step solvers. Losses that do not depend on the load are a
/// CoulombFriction or ViscousFriction of either shaft.
#include "blocks/math/sides.h"
#include "blocks/mechanics/transmission_check.h"
#include "models/contact/transmission.h"

namespace loopwright::blocks {

template <class Real> struct Gear {
  Real ratio, stiffness, efficiency = 1.0, backwards = 0.0, transition = 0.0, gap = 0.0, damping = 0.0;
  Transmission<Real> transmission;
  struct In {
    Real input_angle, input_velocity, output_angle, output_velocity;
  };
  struct Out {
    Real output_torque, input_torque;
  };
  struct Mode {
    Real side;
  };
  struct Crossings {
    Real backward, forward;
  };
  static constexpr auto describe() {
    using T = Gear;
    return block(
        "A gear with ratio, elastic teeth, backlash and losses.",
        parameter(&T::ratio, "ratio", "",
                  "Turns of the input for one turn of the output; negative: it turns back"),
        parameter(&T::stiffness, "stiffness", "N*m/rad", "Torque at the output for each angle of it")
            .positive(),
        parameter(&T::damping, "damping", "N*m*s/rad", "Damping of the same").not_negative().optional(),
        parameter(&T::gap, "gap", "rad", "Free travel of the output between the flanks")
            .not_negative()
            .optional(),
        parameter(&T::efficiency, "efficiency", "", "Power at the output for each power at the input")
            .between(0, 1)
            .optional(),
        parameter(&T::backwards, "backwards_efficiency", "", "When the load drives; 0: as efficiency")
            .between(0, 1)
            .optional(),
        parameter(&T::transition, "transition", "rad/s",
                  "Width in the output's velocity over which losses change sign")
            .not_negative()
            .optional(),
        input(&In::input_angle, "input_angle", "rad", "Angle of the driving shaft"),
        input(&In::input_velocity, "input_velocity", "rad/s", "Its velocity"),
        input(&In::output_angle, "output_angle", "rad", "Angle of the driven shaft"),
        input(&In::output_velocity, "output_velocity", "rad/s", "Its velocity"),
        output(&Out::output_torque, "output_torque", "N*m", "Torque that drives the load"),
        output(&Out::input_torque, "input_torque", "N*m",
               "Torque that the input has to give; subtract it there"),
        crossing(&Crossings::backward, "backward contact"), crossing(&Crossings::forward, "forward contact"));
  }
  bool may_cross() const { return any(gap > 0.0); }
  void check(const Checker& checker) const {
    check_losses(checker, efficiency, backwards, transition);
    if (ratio == 0) checker.error("ratio", "the ratio is zero");
  }
  void prepare(double) {
    transmission =
        Transmission<Real>::of(1.0 / ratio, efficiency, backwards, transition, gap, stiffness, damping);
  }
  Fault decide(const In& in, Mode& mode) const {
    mode.side = transmission.side(deflection(in), approach(in));
    return fault_if_nan(deflection(in), approach(in));
  }
  void outputs(const In& in, const Mode& mode, Out& out) const {
    out.output_torque = transmission.force(mode.side, deflection(in), approach(in));
    out.input_torque = transmission.at_input(out.output_torque, in.output_velocity);
  }
  void crossings(const In& in, Crossings& value) const {
    value.backward = not_below_zero(transmission.contact.low_pressing(deflection(in), approach(in)));
    value.forward = not_below_zero(transmission.contact.high_pressing(deflection(in), approach(in)));
  }

 private:
  Real deflection(const In& in) const { return transmission.travel * in.input_angle - in.output_angle; }
  Real approach(const In& in) const { return transmission.travel * in.input_velocity - in.output_velocity; }
};
LOOPWRIGHT_BLOCK(Gear)

}  // namespace loopwright::blocks
