/// u = Kp e + Kd ω s/(s+ω) e,  e = reference - measured
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct ContinuousPdController {
  Real Kp, Kd, derivative_pole, initial = 0.0;
  struct In {
    Real reference, measured;
  };
  struct Out {
    Real command;
  };
  struct State {
    Real slow_error;
  };
  static constexpr auto describe() {
    using B = ContinuousPdController;
    return block(
        "Proportional feedback of an error and of its filtered derivative, in continuous time.",
        parameter(&B::Kp, "Kp", "$command/$signal", "Proportional gain"),
        parameter(&B::Kd, "Kd", "$command*s/$signal", "Derivative gain"),
        parameter(&B::derivative_pole, "derivative_pole", "rad/s", "Bandwidth of the derivative").positive(),
        parameter(&B::initial, "initial", "$signal", "The error before the start").optional(),
        input(&In::reference, "reference", "$signal", "What is wanted"),
        input(&In::measured, "measured", "$signal", "What is"),
        output(&Out::command, "command", "$command", "What to do about it"));
  }
  void start(State& state) const { state.slow_error = initial; }
  void outputs(const In& in, const State& state, Out& out) const {
    const Real error = in.reference - in.measured;
    out.command = Kp * error + Kd * (derivative_pole * (error - state.slow_error));
  }
  void derivatives(const In& in, const State& state, State& rate) const {
    rate.slow_error = derivative_pole * (in.reference - in.measured - state.slow_error);
  }
};
LOOPWRIGHT_BLOCK(ContinuousPdController)

}  // namespace loopwright::blocks
