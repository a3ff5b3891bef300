/// Y/U = K (1 + s/ω_z) / (1 + s/ω_p)
///
/// A lead, which advances the phase, for ω_z < ω_p; a lag for ω_z > ω_p. K is the DC gain. It starts at rest
/// with the input `initial`.
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct ContinuousLeadLag {
  Real gain = 1.0, zero, pole, initial = 0.0;
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  struct State {
    Real slow;
  };
  static constexpr auto describe() {
    using B = ContinuousLeadLag;
    return block(
        "Advances or retards the phase of a signal around a frequency, in continuous time.",
        parameter(&B::gain, "gain", "$y/$u", "Gain at rest").factor().optional(),
        parameter(&B::zero, "zero", "rad/s", "Where the gain begins to change with frequency, upwards")
            .positive(),
        parameter(&B::pole, "pole", "rad/s", "Where the gain begins to change downwards").positive(),
        parameter(&B::initial, "initial", "$u", "Input before the start").optional(),
        input(&In::u, "u", "$u", "Signal"), output(&Out::y, "y", "$y", "The filtered signal"));
  }
  void start(State& state) const { state.slow = initial; }
  void outputs(const In& in, const State& state, Out& out) const {
    out.y = gain * (state.slow + pole * (in.u - state.slow) / zero);
  }
  void derivatives(const In& in, const State& state, State& rate) const {
    rate.slow = pole * (in.u - state.slow);
  }
};
LOOPWRIGHT_BLOCK(ContinuousLeadLag)

}  // namespace loopwright::blocks
