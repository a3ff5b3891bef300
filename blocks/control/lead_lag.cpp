/// Y/U = K (1 + s/ω_z) / (1 + s/ω_p), by Tustin's rule
///
/// A lead, which advances the phase, for ω_z < ω_p; a lag for ω_z > ω_p. K is the DC gain. It starts at rest
/// with the input `initial`.
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct LeadLag {
  Real gain = 1.0, zero, pole, initial = 0.0;
  Real present, past, keep;
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  struct Memory {
    Real held;
  };
  static constexpr auto describe() {
    return block(
        "Advances or retards the phase of a signal around a frequency, sampled.",
        parameter(&LeadLag::gain, "gain", "$y/$u", "Gain at rest").factor().optional(),
        parameter(&LeadLag::zero, "zero", "rad/s", "Where the gain begins to change with frequency, upwards")
            .positive(),
        parameter(&LeadLag::pole, "pole", "rad/s", "Where the gain begins to change downwards").positive(),
        parameter(&LeadLag::initial, "initial", "$u", "Input before the start").optional(),
        input(&In::u, "u", "$u", "Signal"), output(&Out::y, "y", "$y", "The filtered signal"));
  }
  void prepare(double sample_time) {
    const Real up = 2.0 / (sample_time * zero), down = 2.0 / (sample_time * pole), scale = 1.0 / (1.0 + down);
    present = gain * (1.0 + up) * scale;
    past = gain * (1.0 - up) * scale;
    keep = (down - 1.0) * scale;
  }
  void start(Memory& memory) const { memory.held = (gain - present) * initial; }
  void outputs(const In& in, const Memory& memory, Out& out) const { out.y = present * in.u + memory.held; }
  void update(const In& in, Memory& memory) const {
    memory.held = past * in.u + keep * (present * in.u + memory.held);
  }
};
LOOPWRIGHT_BLOCK(LeadLag)

}  // namespace loopwright::blocks
