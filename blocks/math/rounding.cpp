/// y = the whole number nearest to u (halves to even), or next to it in one direction
///
/// For numbers without unit only: a rounded length would depend on its unit. A Quantizer rounds to multiples
/// of a resolution.
#include "blocks/math/sides.h"

namespace loopwright::blocks {

enum class RoundingRule { nearest, floor, ceiling, toward_zero };
constexpr auto names_of(RoundingRule) {
  return std::array<std::string_view, 4>{"nearest", "floor", "ceiling", "toward_zero"};
}

template <class Real> struct Rounding {
  RoundingRule rule = RoundingRule::nearest;
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  struct Mode {
    Real whole;
  };
  struct Crossings {
    Real lower, upper;
  };
  static constexpr bool decides_anew = true;
  static constexpr auto describe() {
    return block("Rounds a number to a whole one.",
                 parameter(&Rounding::rule, "rule", "", "To which whole number").optional(),
                 input(&In::u, "u", "", "Number without unit"), output(&Out::y, "y", "", "Whole number"),
                 crossing(&Crossings::lower, "lower"), crossing(&Crossings::upper, "upper"));
  }
  void decide(const In& in, Mode& mode) const { mode.whole = rounded(in.u) + 0.0; }  // -0 becomes 0
  void outputs(const Mode& mode, Out& out) const { out.y = mode.whole; }
  /// The ends of the interval that is rounded to the present number; `holds_end` where an end belongs to it.
  void crossings(const In& in, const Mode& mode, Crossings& value) const {
    const Real n = mode.whole;
    const auto is_even = 2.0 * round_even(Real(0.5 * n)) == n;
    Real low = n - 0.5, high = n + 0.5;
    MaskOf<Real> holds_low = is_even, holds_high = is_even;
    if (rule != RoundingRule::nearest) {
      const auto goes_down = rule == RoundingRule::floor     ? MaskOf<Real>(true)
                             : rule == RoundingRule::ceiling ? MaskOf<Real>(false)
                                                             : n > 0.0;
      const auto goes_up = rule == RoundingRule::toward_zero ? n < 0.0 : !goes_down;
      low = select(goes_down, n, n - 1.0), high = select(goes_up, n, n + 1.0);
      holds_low = goes_down, holds_high = goes_up;
    }
    value.lower = select(holds_low, not_below_zero(Real(in.u - low)), above_zero(Real(in.u - low)));
    value.upper = select(holds_high, above_zero(Real(in.u - high)), not_below_zero(Real(in.u - high)));
  }

 private:
  Real rounded(const Real& u) const {
    switch (rule) {
      case RoundingRule::nearest:
        return round_even(u);
      case RoundingRule::floor:
        return floor_of(u);
      case RoundingRule::ceiling:
        return -floor_of(Real(-u));
      case RoundingRule::toward_zero:
        return select(u < 0.0, Real(-floor_of(Real(-u))), floor_of(u));
    }
    return u;
  }
};
LOOPWRIGHT_BLOCK(Rounding)

}  // namespace loopwright::blocks
