/// y = choices[index], counted from 0, index rounded to the nearest whole number
#include "blocks/math/sides.h"

namespace loopwright::blocks {

template <class Real> struct MultiportSwitch {
  struct In {
    Real index;
    Many<Real> choices;
  };
  struct Out {
    Real y;
  };
  struct Mode {
    Real chosen;
  };
  struct Crossings {
    Real lower, upper;
  };
  static constexpr bool decides_anew = true;
  static constexpr auto describe() {
    return block(
        "Chooses one of several signals by its number.",
        input(&In::index, "index", "", "Which choice, counted from 0; one that does not exist is a fault"),
        input(&In::choices, "choices", "$y", "Signals of one unit"),
        output(&Out::y, "y", "$y", "The chosen signal"), crossing(&Crossings::lower, "lower"),
        crossing(&Crossings::upper, "upper"));
  }
  Fault decide(const In& in, Mode& mode) const {
    mode.chosen = floor_of(Real(in.index + 0.5));
    const auto exists = (mode.chosen >= 0.0) & (mode.chosen < double(in.choices.size()));
    return fault_if(!exists, "the index names no choice");
  }
  void outputs(const In& in, const Mode& mode, Out& out) const {
    out.y = in.choices[0];
    for (int i = 1; i < in.choices.size(); ++i)
      out.y = select(mode.chosen == double(i), in.choices[i], out.y);
  }
  void crossings(const In& in, const Mode& mode, Crossings& value) const {
    value.lower = not_below_zero(Real(in.index - mode.chosen + 0.5));
    value.upper = not_below_zero(Real(in.index - mode.chosen - 0.5));
  }
};
LOOPWRIGHT_BLOCK(MultiportSwitch)

}  // namespace loopwright::blocks
