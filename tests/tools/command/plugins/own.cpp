// A user's block with an unused name.
#include "engine/block.h"

namespace loopwright::blocks {
template <class Real> struct Doubled {
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  static constexpr auto describe() {
    return block("Twice the input.", input(&In::u, "u", "$y", "What is doubled"),
                 output(&Out::y, "y", "$y", "Twice u"));
  }
  void outputs(const In& in, Out& out) const { out.y = 2.0 * in.u; }
};
LOOPWRIGHT_BLOCK(Doubled)
}  // namespace loopwright::blocks
