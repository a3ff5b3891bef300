/// y = 1 where `a operator b` holds, else 0
///
/// With hysteresis h, an inequality that holds ceases to hold only where a lies beyond b by more than h. At
/// the start it does not hold.
#include "blocks/math/sides.h"

namespace loopwright::blocks {

enum class Relation { less, less_or_equal, greater, greater_or_equal, equal, not_equal };
constexpr auto names_of(Relation) {
  return std::array<std::string_view, 6>{"<", "<=", ">", ">=", "==", "!="};
}

template <class Real> struct Comparison {
  Relation relation;
  Real hysteresis = 0.0;
  struct In {
    Real a, b;
  };
  struct Out {
    Real y;
  };
  struct Mode {
    Real holds;
  };
  struct Crossings {
    Real above, below;
  };
  static constexpr auto describe() {
    return block(
        "Compares two signals.", parameter(&Comparison::relation, "operator", "", "What is asked of a and b"),
        parameter(&Comparison::hysteresis, "hysteresis", "$a", "How far a must go back for it to cease")
            .difference()
            .not_negative()
            .optional(),
        input(&In::a, "a", "$a", "Left side"), input(&In::b, "b", "$a", "Right side").otherwise(0.0),
        output(&Out::y, "y", "", "1 where it holds, else 0"), crossing(&Crossings::above, "above"),
        crossing(&Crossings::below, "below"));
  }
  void check(const Checker& checker) const {
    if (hysteresis > 0.0 && (relation == Relation::equal || relation == Relation::not_equal))
      checker.error("hysteresis", "only an inequality can have hysteresis").expected = "<, <=, > or >=";
  }
  Fault decide(const In& in, Mode& mode) const {
    mode.holds = select(holds(helped(in.a, mode), in.b), Real(1.0), Real(0.0));
    return fault_if_nan(in.a, in.b);
  }
  void outputs(const Mode& mode, Out& out) const { out.y = mode.holds; }
  void crossings(const In& in, const Mode& mode, Crossings& value) const {
    const Real difference = helped(in.a, mode) - in.b;
    value.above = above_zero(difference);
    value.below = not_below_zero(difference);
  }

 private:
  /// a, moved by the hysteresis to where the relation still holds, if it does hold.
  Real helped(const Real& a, const Mode& mode) const {
    const bool is_greater = relation == Relation::greater || relation == Relation::greater_or_equal;
    return a + select(mode.holds > 0.5, is_greater ? hysteresis : Real(-hysteresis), Real(0.0));
  }
  MaskOf<Real> holds(const Real& a, const Real& b) const {
    switch (relation) {
      case Relation::less:
        return a < b;
      case Relation::less_or_equal:
        return a <= b;
      case Relation::greater:
        return a > b;
      case Relation::greater_or_equal:
        return a >= b;
      case Relation::equal:
        return a == b;
      case Relation::not_equal:
        return a != b;
    }
    return a == b;
  }
};
LOOPWRIGHT_BLOCK(Comparison)

}  // namespace loopwright::blocks
