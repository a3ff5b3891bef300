/// y = u - low for u < low, 0 for low ≤ u ≤ high, u - high for u > high
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct DeadZone {
  Real low, high;
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
    return block("Takes no notice of a signal within a zone.",
                 parameter(&DeadZone::low, "low", "$u", "Lower end of the zone"),
                 parameter(&DeadZone::high, "high", "$u", "Upper end of the zone"),
                 input(&In::u, "u", "$u", "Signal"),
                 output(&Out::y, "y", "$u", "How far the signal is outside of the zone"),
                 crossing(&Crossings::low, "low"), crossing(&Crossings::high, "high"));
  }
  void check(const Checker& checker) const {
    if (low <= high) return;
    auto& p = checker.error("low", "the lower end of the zone lies above the upper one");
    p.expected = "low <= high";
    p.found = reading::number_text(low) + " and " + reading::number_text(high);
  }
  void outputs(const In& in, Out& out) const { out.y = in.u - minimum(maximum(in.u, low), high); }
  void crossings(const In& in, Crossings& value) const {
    value.low = in.u - low;
    value.high = in.u - high;
  }
};
LOOPWRIGHT_BLOCK(DeadZone)

}  // namespace loopwright::blocks
