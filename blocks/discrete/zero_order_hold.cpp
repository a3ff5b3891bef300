/// y(t) = u(t_k) for t_k ≤ t < t_{k+1}
///
/// Place it where a continuous signal enters a sampled controller, with the sample time of the controller.
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct ZeroOrderHold {
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  struct Memory {
    Real held;
  };  // a block with memory must have a sample time; otherwise it would hold nothing
  static constexpr auto describe() {
    return block("Samples a signal and holds the sample until the next.", input(&In::u, "u", "$u", "Signal"),
                 output(&Out::y, "y", "$u", "The signal at the last sample"));
  }
  void outputs(const In& in, Out& out) const { out.y = in.u; }
  void update(const In& in, Memory& memory) const { memory.held = in.u; }
};
LOOPWRIGHT_BLOCK(ZeroOrderHold)

}  // namespace loopwright::blocks
