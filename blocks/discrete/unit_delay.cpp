/// y[k] = u[k-1],  y[0] = initial
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct UnitDelay {
  Real initial = 0.0;
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  struct Memory {
    Real last;
  };
  static constexpr auto describe() {
    return block("Delays a signal by one sample.",
                 parameter(&UnitDelay::initial, "initial", "$u", "Output at the first sample").optional(),
                 input(&In::u, "u", "$u", "Signal"),
                 output(&Out::y, "y", "$u", "The signal, one sample ago").from_memory());
  }
  void start(Memory& memory) const { memory.last = initial; }
  void outputs(const Memory& memory, Out& out) const { out.y = memory.last; }
  void update(const In& in, Memory& memory) const { memory.last = in.u; }
};
LOOPWRIGHT_BLOCK(UnitDelay)

}  // namespace loopwright::blocks
