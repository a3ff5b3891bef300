/// Y/U = (s² + 2 ζ₀ ω s + ω²) / (s² + 2 ζ₁ ω s + ω²), by Tustin's rule with ω mapped exactly
///
/// At ω the gain is ζ₀/ζ₁: with `depth_damping` 0 it is zero. `width_damping` sets the width of the notch.
/// The DC gain is 1. ω must be less than half the sampling frequency, π/T. It starts at rest with the input
/// `initial`.
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct Notch {
  Real frequency, depth_damping = 0.0, width_damping, initial = 0.0;
  Real b0, b1, b2, a2, half_turn;  // a1 = b1
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  struct Memory {
    Real s1, s2;
  };  // transposed direct form II
  static constexpr auto describe() {
    return block(
        "Takes a narrow band of frequencies, such as a resonance, out of a signal; sampled.",
        parameter(&Notch::frequency, "frequency", "rad/s", "Centre of the band").positive(),
        parameter(&Notch::depth_damping, "depth_damping", "", "Damping of the numerator")
            .not_negative()
            .optional(),
        parameter(&Notch::width_damping, "width_damping", "", "Damping of the denominator").positive(),
        parameter(&Notch::initial, "initial", "$u", "Input before the start").optional(),
        input(&In::u, "u", "$u", "Signal"), output(&Out::y, "y", "$u", "The signal without the band"));
  }
  void prepare(double sample_time) {
    half_turn = 0.5 * sample_time * frequency;
    const Real s = sine(half_turn), c = cosine(half_turn);  // Tustin with s → ω cot(ωT/2) (z-1)/(z+1)
    const Real turn = 2.0 * s * c, scale = 1.0 / (1.0 + width_damping * turn);
    b0 = (1.0 + depth_damping * turn) * scale;
    b1 = 2.0 * (s - c) * (s + c) * scale;
    b2 = (1.0 - depth_damping * turn) * scale;
    a2 = (1.0 - width_damping * turn) * scale;
  }
  void start(Memory& memory) const { memory.s1 = memory.s2 = (b2 - a2) * initial; }  // such that y = u
  Fault outputs(const In& in, const Memory& memory, Out& out) const {
    out.y = b0 * in.u + memory.s1;
    return fault_if(half_turn >= 0.5 * pi, "the notch does not lie below half the sampling frequency");
  }
  void update(const In& in, Memory& memory) const {
    const Real y = b0 * in.u + memory.s1;
    const Real s1 = b1 * (in.u - y) + memory.s2;
    memory.s2 = b2 * in.u - a2 * y;
    memory.s1 = s1;
  }
};
LOOPWRIGHT_BLOCK(Notch)

}  // namespace loopwright::blocks
