/// T dF/dt = u - F
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct ActuatorLag {
  Real time_constant, initial = 0.0;
  Real rate_constant;
  struct In {
    Real command;
  };
  struct State {
    Real force;
  };
  static constexpr auto describe() {
    return block(
        "An actuator that follows its command with a first-order lag, as a current loop does.",
        parameter(&ActuatorLag::time_constant, "time_constant", "s", "Time for 63 % of a step").positive(),
        parameter(&ActuatorLag::initial, "initial", "$force", "Force at the start").optional(),
        input(&In::command, "command", "$force", "Force that is asked for"),
        output(&State::force, "force", "$force", "Force that the actuator gives"));
  }
  void prepare(double) { rate_constant = 1.0 / time_constant; }
  void start(State& state) const { state.force = initial; }
  void derivatives(const In& in, const State& state, State& rate) const {
    rate.force = (in.command - state.force) * rate_constant;
  }
};
LOOPWRIGHT_BLOCK(ActuatorLag)

}  // namespace loopwright::blocks
