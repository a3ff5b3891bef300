/// d = radius θ - x;  F = k d + c d'
///
/// M = F radius / η while the pulley drives, F η' radius while the carriage drives, joined by
/// tanh(v / transition) around rest. The belt is under tension: both strands hold, and k is the sum of their
/// stiffnesses. The pulleys' inertia is an `Inertia`, the carriage a `Mass`.
#include "blocks/mechanics/transmission_check.h"
#include "models/contact/transmission.h"

namespace loopwright::blocks {

template <class Real> struct BeltDrive {
  Real radius, stiffness, efficiency = 1.0, backwards = 0.0, transition = 0.0, damping = 0.0;
  Transmission<Real> transmission;
  struct In {
    Real angle, angular_velocity, position, velocity;
  };
  struct Out {
    Real force, torque;
  };
  static constexpr auto describe() {
    using T = BeltDrive;
    return block(
        "A toothed belt between a pulley and a carriage.",
        parameter(&T::radius, "radius", "m",
                  "Effective radius of the pulley; of z teeth with the pitch p: z p / 2π")
            .positive(),
        parameter(&T::stiffness, "stiffness", "N/m", "Stiffness of both strands together").positive(),
        parameter(&T::damping, "damping", "N*s/m", "Damping of the same").not_negative().optional(),
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
        input(&In::angle, "angle", "rad", "Angle of the pulley"),
        input(&In::angular_velocity, "angular_velocity", "rad/s", "Its velocity"),
        input(&In::position, "position", "m", "Position of the carriage"),
        input(&In::velocity, "velocity", "m/s", "Its velocity"),
        output(&Out::force, "force", "N", "Force that drives the carriage"),
        output(&Out::torque, "torque", "N*m", "Torque that the pulley takes; subtract it at the motor"));
  }
  void check(const Checker& checker) const { check_losses(checker, efficiency, backwards, transition); }
  void prepare(double) {
    transmission = Transmission<Real>::of(radius, efficiency, backwards, transition, 0.0, stiffness, damping);
  }
  void outputs(const In& in, Out& out) const {
    out.force = stiffness * deflection(in) + damping * approach(in);
    out.torque = transmission.at_input(out.force, in.velocity);
  }

 private:
  Real deflection(const In& in) const { return transmission.travel * in.angle - in.position; }
  Real approach(const In& in) const { return transmission.travel * in.angular_velocity - in.velocity; }
};
LOOPWRIGHT_BLOCK(BeltDrive)

}  // namespace loopwright::blocks
