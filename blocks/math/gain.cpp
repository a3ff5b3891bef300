/// y = K u
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct Gain {
  Real gain;
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  static constexpr auto describe() {
    return block("Multiplies a signal by a number.",
                 parameter(&Gain::gain, "gain", "$y/$u", "Factor").factor(),
                 input(&In::u, "u", "$u", "Signal"), output(&Out::y, "y", "$y", "The signal, multiplied"));
  }
  void outputs(const In& in, Out& out) const { out.y = gain * in.u; }
};
LOOPWRIGHT_BLOCK(Gain)

}  // namespace loopwright::blocks
