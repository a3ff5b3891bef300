/// Y/U = ω s/(s+ω)
///
/// A causal block cannot give the exact derivative of an unknown signal: this one lags by 1/ω and amplifies
/// noise up to ω. It starts as if the signal had always been `initial`. Any other first value gives a peak of
/// ω times the step.
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct Derivative {
  Real cutoff, initial = 0.0;
  struct In {
    Real u;
  };
  struct State {
    Real slow;
  };
  struct Out {
    Real y;
  };
  static constexpr auto describe() {
    return block(
        "Differentiates a signal, filtered.",
        parameter(&Derivative::cutoff, "cutoff", "rad/s", "Bandwidth of the filter").positive(),
        parameter(&Derivative::initial, "initial", "$u", "Value of the signal before the start").optional(),
        input(&In::u, "u", "$u", "Signal"), output(&Out::y, "y", "$u/s", "Its filtered rate of change"));
  }
  void start(State& state) const { state.slow = initial; }
  void outputs(const In& in, const State& state, Out& out) const { out.y = cutoff * (in.u - state.slow); }
  void derivatives(const In& in, const State& state, State& rate) const {
    rate.slow = cutoff * (in.u - state.slow);
  }
};
LOOPWRIGHT_BLOCK(Derivative)

}  // namespace loopwright::blocks
