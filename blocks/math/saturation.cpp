/// y = min(max(u, low), high)
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct Saturation {
  Real low = -infinity, high = infinity;
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  struct Crossings {
    Real low, high;
  };
  static constexpr auto describe() {
    return block(
        "Holds a signal within limits.", parameter(&Saturation::low, "low", "$u", "Lower limit").optional(),
        parameter(&Saturation::high, "high", "$u", "Upper limit").optional(),
        input(&In::u, "u", "$u", "Signal"), output(&Out::y, "y", "$u", "The signal within the limits"),
        crossing(&Crossings::low, "low"), crossing(&Crossings::high, "high"));
  }
  void check(const Checker& checker) const {
    if (low <= high) return;
    auto& p = checker.error("low", "the lower limit lies above the upper one");
    p.expected = "low <= high";
    p.found = reading::number_text(low) + " and " + reading::number_text(high);
  }
  void outputs(const In& in, Out& out) const { out.y = minimum(maximum(in.u, low), high); }
  void crossings(const In& in, Crossings& value) const {
    value.low = minimum(Real(in.u - low), Real(1e300));  // finite also without a limit
    value.high = maximum(Real(in.u - high), Real(-1e300));
  }
};
LOOPWRIGHT_BLOCK(Saturation)

}  // namespace loopwright::blocks
