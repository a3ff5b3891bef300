/// y = √u
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct SquareRoot {
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  static constexpr auto describe() {
    return block("The square root of a signal.", input(&In::u, "u", "?", "Signal, not below 0"),
                 output(&Out::y, "y", "$y", "Its square root"));
  }
  double unit_power(int) const { return 0.5; }
  Fault outputs(const In& in, Out& out) const {
    out.y = square_root(in.u);
    return fault_if(!(in.u >= 0.0), "the square root of a number below 0");
  }
};
LOOPWRIGHT_BLOCK(SquareRoot)

}  // namespace loopwright::blocks
