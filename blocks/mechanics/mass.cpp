/// (m + m_payload) dv/dt = F,  dx/dt = v
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct Mass {
  Real mass, payload = 0.0, initial_position = 0.0, initial_velocity = 0.0;
  Real per_mass;
  struct In {
    Real force;
  };
  struct State {
    Real position, velocity;
  };
  struct Out {
    Real acceleration;
  };
  static constexpr auto describe() {
    return block(
        "A mass that moves along one line, with a payload on it.",
        parameter(&Mass::mass, "mass", "$force*s^2/$position", "Moving mass without payload").positive(),
        parameter(&Mass::payload, "payload", "$force*s^2/$position", "Mass carried on top")
            .not_negative()
            .optional(),
        parameter(&Mass::initial_position, "initial_position", "$position", "Position at the start")
            .optional(),
        parameter(&Mass::initial_velocity, "initial_velocity", "$position/s", "Velocity at the start")
            .optional(),
        input(&In::force, "force", "$force", "Sum of the forces on the mass"),
        output(&State::position, "position", "$position", "Where it is"),
        output(&State::velocity, "velocity", "$position/s", "How fast it moves"),
        output(&Out::acceleration, "acceleration", "$position/s^2", "How fast it gains speed")
            .from(&In::force));
  }
  void prepare(double) { per_mass = 1.0 / (mass + payload); }
  void start(State& state) const {
    state.position = initial_position;
    state.velocity = initial_velocity;
  }
  void outputs(const In& in, Out& out) const { out.acceleration = in.force * per_mass; }
  void derivatives(const In& in, const State& state, State& rate) const {
    rate.position = state.velocity;
    rate.velocity = in.force * per_mass;
  }
};
LOOPWRIGHT_BLOCK(Mass)

}  // namespace loopwright::blocks
