/// Y/U = (s² + 2 ζ₀ ω s + ω²) / (s² + 2 ζ₁ ω s + ω²)
///
/// At ω the gain is ζ₀/ζ₁: with `depth_damping` 0 it is zero. `width_damping` sets the width of the notch.
/// The DC gain is 1. It starts at rest with the input `initial`.
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct ContinuousNotch {
  Real frequency, depth_damping = 0.0, width_damping, initial = 0.0;
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  struct State {
    Real slow, band;  // ω²/(s² + 2 ζ₁ ω s + ω²) u, and ω s/(…) u
  };
  static constexpr auto describe() {
    using B = ContinuousNotch;
    return block(
        "Takes a narrow band of frequencies, such as a resonance, out of a signal, in continuous time.",
        parameter(&B::frequency, "frequency", "rad/s", "Centre of the band").positive(),
        parameter(&B::depth_damping, "depth_damping", "", "Damping of the numerator")
            .not_negative()
            .optional(),
        parameter(&B::width_damping, "width_damping", "", "Damping of the denominator").positive(),
        parameter(&B::initial, "initial", "$u", "Input before the start").optional(),
        input(&In::u, "u", "$u", "Signal"), output(&Out::y, "y", "$u", "The signal without the band"));
  }
  void start(State& state) const { state.slow = initial; }
  void outputs(const In& in, const State& state, Out& out) const {
    out.y = in.u - 2.0 * (width_damping - depth_damping) * state.band;
  }
  void derivatives(const In& in, const State& state, State& rate) const {
    rate.slow = frequency * state.band;
    rate.band = frequency * (in.u - 2.0 * width_damping * state.band - state.slow);
  }
};
LOOPWRIGHT_BLOCK(ContinuousNotch)

}  // namespace loopwright::blocks
