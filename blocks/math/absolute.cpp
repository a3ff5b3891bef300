/// y = |u|
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct Absolute {
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  struct Crossings {
    Real sign;
  };
  static constexpr auto describe() {
    return block("The size of a signal without its sign.", input(&In::u, "u", "$u", "Signal"),
                 output(&Out::y, "y", "$u", "Its size"), crossing(&Crossings::sign, "sign"));
  }
  void outputs(const In& in, Out& out) const { out.y = absolute(in.u); }
  void crossings(const In& in, Crossings& value) const { value.sign = in.u; }
};
LOOPWRIGHT_BLOCK(Absolute)

}  // namespace loopwright::blocks
