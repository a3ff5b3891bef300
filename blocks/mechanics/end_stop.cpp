/// F = max(0, k (x - high) + c v) at the high stop, min(0, k (x - low) + c v) at the low one, else 0
#include "blocks/math/sides.h"
#include "models/contact/gap_contact.h"

namespace loopwright::blocks {

/// One stop or two: a limit that is not given does not exist. The stop pushes and never pulls. Contact and
/// separation are events for variable-step solvers. A fixed step h should be well below √(m/k).
template <class Real> struct EndStop {
  Real low = -infinity, high = infinity, stiffness, damping = 0.0;
  GapContact<Real> contact;
  struct In {
    Real position, velocity;
  };
  struct Out {
    Real force;
  };
  struct Mode {
    Real side;
  };
  struct Crossings {
    Real low, high;
  };
  static constexpr bool decides_anew = true;
  static constexpr auto describe() {
    return block(
        "Elastic stops at the ends of the travel; subtract their force in the sum of forces.",
        parameter(&EndStop::low, "low", "$position", "Where the low stop is; none if left out").optional(),
        parameter(&EndStop::high, "high", "$position", "Where the high stop is; none if left out").optional(),
        parameter(&EndStop::stiffness, "stiffness", "$force/$position", "Force per indentation").positive(),
        parameter(&EndStop::damping, "damping", "$force*s/$position", "Force per speed while in contact")
            .not_negative()
            .optional(),
        input(&In::position, "position", "$position", "Position of the moving part"),
        input(&In::velocity, "velocity", "$position/s", "Its velocity"),
        output(&Out::force, "force", "$force", "Contact force, positive at the high stop: to be subtracted"),
        crossing(&Crossings::low, "low stop"), crossing(&Crossings::high, "high stop"));
  }
  void check(const Checker& checker) const {
    if (low < high) return;
    checker.error("low", "there is no travel between the stops").expected = "low < high";
  }
  void prepare(double) { contact = {low, high, stiffness, damping, 1.0 / stiffness}; }
  Fault decide(const In& in, Mode& mode) const {
    mode.side = contact.side(in.position, in.velocity);
    return fault_if_nan(in.position, in.velocity);
  }
  void outputs(const In& in, const Mode& mode, Out& out) const {
    out.force = contact.force(mode.side, in.position, in.velocity);
  }
  void crossings(const In& in, Crossings& value) const {
    value.low = not_below_zero(contact.low_pressing(in.position, in.velocity));
    value.high = not_below_zero(contact.high_pressing(in.position, in.velocity));
  }
};
LOOPWRIGHT_BLOCK(EndStop)

}  // namespace loopwright::blocks
