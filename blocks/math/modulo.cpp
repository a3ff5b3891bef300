/// y = u - n d, with the whole number n for which low ≤ y < low + d
///
/// With d = 2π and low = -π it wraps an angle. Each jump is an event for a variable-step solver.
#include "blocks/math/sides.h"

namespace loopwright::blocks {

template <class Real> struct Modulo {
  Real divisor, low = 0.0;
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  struct Mode {
    Real turns;
  };
  struct Crossings {
    Real lower, upper;
  };
  static constexpr bool decides_anew = true;
  static constexpr auto describe() {
    return block("The rest of a signal after a division.",
                 parameter(&Modulo::divisor, "divisor", "$u", "What is taken away as often as it fits")
                     .difference()
                     .positive(),
                 parameter(&Modulo::low, "low", "$u", "Least value of the rest").optional(),
                 input(&In::u, "u", "$u", "Signal"), output(&Out::y, "y", "$u", "The rest"),
                 crossing(&Crossings::lower, "lower"), crossing(&Crossings::upper, "upper"));
  }
  void decide(const In& in, Mode& mode) const {
    const Real turns = floor_of(Real((in.u - low) / divisor));
    // The division has rounded: it may be off by one.
    mode.turns = select(above_low(in.u, turns) < 0.0, turns - 1.0,
                        select(above_low(in.u, turns + 1.0) >= 0.0, turns + 1.0, turns)) +
                 0.0;  // -0 becomes 0
  }
  Fault outputs(const In& in, const Mode& mode, Out& out) const {
    out.y = in.u - mode.turns * divisor;
    return fault_if(!(absolute(mode.turns) < 0x1p52), "the signal is too large to have a rest");
  }
  void crossings(const In& in, const Mode& mode, Crossings& value) const {
    value.lower = not_below_zero(above_low(in.u, mode.turns));
    value.upper = not_below_zero(above_low(in.u, mode.turns + 1.0));
  }

 private:
  /// The decision and its bounds come from this one function, so that they agree whatever it rounds.
  Real above_low(const Real& u, const Real& turns) const { return (u - turns * divisor) - low; }
};
LOOPWRIGHT_BLOCK(Modulo)

}  // namespace loopwright::blocks
