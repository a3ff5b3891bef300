/// m₁ x₁'' = F - f,  m₂ x₂'' = f - F_load,  f = k (x₁ - x₂) + c (x₁' - x₂')
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct TwoMass {
  Real motor_mass, load_mass, stiffness, damping = 0.0, initial_position = 0.0, initial_velocity = 0.0;
  Real per_motor_mass, per_load_mass;
  struct In {
    Real force, load_force;
  };
  struct State {
    Real motor_position, motor_velocity, load_position, load_velocity;
  };
  struct Out {
    Real coupling_force;
  };
  static constexpr auto describe() {
    return block(
        "A motor and a load joined by an elastic coupling.",
        parameter(&TwoMass::motor_mass, "motor_mass", "$force*s^2/$position", "Mass on the driven side")
            .positive(),
        parameter(&TwoMass::load_mass, "load_mass", "$force*s^2/$position", "Mass beyond the coupling")
            .positive(),
        parameter(&TwoMass::stiffness, "stiffness", "$force/$position", "Stiffness of the coupling")
            .not_negative(),
        parameter(&TwoMass::damping, "damping", "$force*s/$position", "Damping of the coupling")
            .not_negative()
            .optional(),
        parameter(&TwoMass::initial_position, "initial_position", "$position",
                  "Position of both at the start")
            .optional(),
        parameter(&TwoMass::initial_velocity, "initial_velocity", "$position/s",
                  "Velocity of both at the start")
            .optional(),
        input(&In::force, "force", "$force", "Sum of the forces on the motor"),
        input(&In::load_force, "load_force", "$force", "Sum of the forces that hold the load back")
            .otherwise(0.0),
        output(&State::motor_position, "motor_position", "$position", "Where the motor is"),
        output(&State::motor_velocity, "motor_velocity", "$position/s", "How fast the motor moves"),
        output(&State::load_position, "load_position", "$position", "Where the load is"),
        output(&State::load_velocity, "load_velocity", "$position/s", "How fast the load moves"),
        output(&Out::coupling_force, "coupling_force", "$force",
               "Force through the coupling, driving the load")
            .from_memory());
  }
  void prepare(double) {
    per_motor_mass = 1.0 / motor_mass;
    per_load_mass = 1.0 / load_mass;
  }
  void start(State& state) const {
    state = {initial_position, initial_velocity, initial_position, initial_velocity};
  }
  Real coupling(const State& s) const {
    return stiffness * (s.motor_position - s.load_position) + damping * (s.motor_velocity - s.load_velocity);
  }
  void outputs(const State& state, Out& out) const { out.coupling_force = coupling(state); }
  void derivatives(const In& in, const State& state, State& rate) const {
    const Real force = coupling(state);
    rate.motor_position = state.motor_velocity;
    rate.motor_velocity = (in.force - force) * per_motor_mass;
    rate.load_position = state.load_velocity;
    rate.load_velocity = (force - in.load_force) * per_load_mass;
  }
};
LOOPWRIGHT_BLOCK(TwoMass)

}  // namespace loopwright::blocks
