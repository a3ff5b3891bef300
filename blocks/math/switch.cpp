/// y = first where control > threshold, else second
#include "blocks/math/sides.h"

namespace loopwright::blocks {

template <class Real> struct Switch {
  Real threshold = 0.5;
  struct In {
    Real control, first, second;
  };
  struct Out {
    Real y;
  };
  struct Mode {
    Real is_first;
  };
  struct Crossings {
    Real control;
  };
  static constexpr bool decides_anew = true;
  static constexpr auto describe() {
    return block(
        "Chooses one of two signals by a third.",
        parameter(&Switch::threshold, "threshold", "$control", "Above this the first is chosen").optional(),
        input(&In::control, "control", "$control", "What decides"),
        input(&In::first, "first", "$y", "Signal while the control is above the threshold"),
        input(&In::second, "second", "$y", "Signal otherwise"),
        output(&Out::y, "y", "$y", "The chosen signal"), crossing(&Crossings::control, "control"));
  }
  Fault decide(const In& in, Mode& mode) const {
    mode.is_first = select(in.control > threshold, Real(1.0), Real(0.0));
    return fault_if_nan(in.control);
  }
  void outputs(const In& in, const Mode& mode, Out& out) const {
    out.y = select(mode.is_first > 0.5, in.first, in.second);
  }
  void crossings(const In& in, Crossings& value) const {
    value.control = above_zero(Real(in.control - threshold));
  }
};
LOOPWRIGHT_BLOCK(Switch)

}  // namespace loopwright::blocks
