/// y = 1 for u > 0, -1 for u < 0, 0 for u = 0
///
/// In a loop that drives u back to zero (dry friction) it chatters. Use a friction block with a smooth law or
/// with sticking there.
#include "blocks/math/sides.h"

namespace loopwright::blocks {

template <class Real> struct Sign {
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  struct Mode {
    Real sign;
  };
  struct Crossings {
    Real above, below;
  };
  static constexpr bool decides_anew = true;
  static constexpr auto describe() {
    return block("The sign of a signal.", input(&In::u, "u", "$u", "Signal"),
                 output(&Out::y, "y", "", "1, -1 or 0"), crossing(&Crossings::above, "above"),
                 crossing(&Crossings::below, "below"));
  }
  Fault decide(const In& in, Mode& mode) const {
    mode.sign = select(in.u > 0.0, Real(1.0), select(in.u < 0.0, Real(-1.0), Real(0.0)));
    return fault_if_nan(in.u);
  }
  void outputs(const Mode& mode, Out& out) const { out.y = mode.sign; }
  void crossings(const In& in, Crossings& value) const {
    value.above = above_zero(in.u);
    value.below = not_below_zero(in.u);
  }
};
LOOPWRIGHT_BLOCK(Sign)

}  // namespace loopwright::blocks
