/// F = k (x_motor - x_load) + c (v_motor - v_load)
#include "engine/block.h"

namespace loopwright::blocks {

/// Couples two masses, each a block of its own. TwoMass is the same in one block; BacklashCoupling has a gap.
template <class Real> struct ElasticCoupling {
  Real stiffness, damping = 0.0;
  struct In {
    Real motor_position, motor_velocity, load_position, load_velocity;
  };
  struct Out {
    Real force;
  };
  static constexpr auto describe() {
    using B = ElasticCoupling;
    return block(
        "Couples a motor and a load by a spring and a damper.",
        parameter(&B::stiffness, "stiffness", "$force/$position", "Force per deflection").not_negative(),
        parameter(&B::damping, "damping", "$force*s/$position", "Force per speed of deflection")
            .not_negative()
            .optional(),
        input(&In::motor_position, "motor_position", "$position", "Position of the driving part"),
        input(&In::motor_velocity, "motor_velocity", "$position/s", "Its velocity"),
        input(&In::load_position, "load_position", "$position", "Position of the driven part"),
        input(&In::load_velocity, "load_velocity", "$position/s", "Its velocity"),
        output(&Out::force, "force", "$force", "Force that drives the load; subtract it at the motor"));
  }
  void outputs(const In& in, Out& out) const {
    out.force =
        stiffness * (in.motor_position - in.load_position) + damping * (in.motor_velocity - in.load_velocity);
  }
};
LOOPWRIGHT_BLOCK(ElasticCoupling)

}  // namespace loopwright::blocks
