/// J dω/dt = M,  dθ/dt = ω
#include "engine/block.h"

namespace loopwright::blocks {

/// The rotary sibling of Mass. What moves behind a rigid gear with the ratio n adds J/n², a mass m behind a
/// screw of the lead h adds m (h/2π)².
template <class Real> struct Inertia {
  Real inertia, initial_angle = 0.0, initial_velocity = 0.0;
  Real per_inertia;
  struct In {
    Real torque;
  };
  struct State {
    Real angle, velocity;
  };
  struct Out {
    Real acceleration;
  };
  static constexpr auto describe() {
    return block(
        "A rotor that turns about one axis.",
        parameter(&Inertia::inertia, "inertia", "kg*m^2", "Moment of inertia").positive(),
        parameter(&Inertia::initial_angle, "initial_angle", "rad", "Angle at the start").optional(),
        parameter(&Inertia::initial_velocity, "initial_velocity", "rad/s", "Velocity at the start")
            .optional(),
        input(&In::torque, "torque", "N*m", "Sum of the torques on the rotor"),
        output(&State::angle, "angle", "rad", "Where it is, over all turns"),
        output(&State::velocity, "velocity", "rad/s", "How fast it turns"),
        output(&Out::acceleration, "acceleration", "rad/s^2", "How fast it gains speed").from(&In::torque));
  }
  void prepare(double) { per_inertia = 1.0 / inertia; }
  void start(State& state) const { state = {initial_angle, initial_velocity}; }
  void outputs(const In& in, Out& out) const { out.acceleration = in.torque * per_inertia; }
  void derivatives(const In& in, const State& state, State& rate) const {
    rate.angle = state.velocity;
    rate.velocity = in.torque * per_inertia;
  }
};
LOOPWRIGHT_BLOCK(Inertia)

}  // namespace loopwright::blocks
