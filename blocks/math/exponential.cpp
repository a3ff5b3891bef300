/// y = eᵘ
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct Exponential {
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  static constexpr auto describe() {
    return block("The exponential function.", input(&In::u, "u", "", "Exponent"),
                 output(&Out::y, "y", "", "Euler's number to this power"));
  }
  Fault outputs(const In& in, Out& out) const {
    out.y = exponential(in.u);
    return fault_if(!is_finite(out.y), "the exponential is too large for a number");
  }
};
LOOPWRIGHT_BLOCK(Exponential)

}  // namespace loopwright::blocks
