/// y = 1 where `a operator b` holds, else 0
#include "blocks/math/sides.h"

namespace loopwright::blocks {

enum class Relation { less, less_or_equal, greater, greater_or_equal, equal, not_equal };
constexpr auto names_of(Relation) {
  return std::array<std::string_view, 6>{"<", "<=", ">", ">=", "==", "!="};
}

template <class Real> struct Comparison {
  Relation relation;
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
    return block("Compares two signals.",
                 parameter(&Comparison::relation, "operator", "", "What is asked of a and b"),
                 input(&In::a, "a", "$a", "Left side"), input(&In::b, "b", "$a", "Right side").otherwise(0.0),
                 output(&Out::y, "y", "", "1 where it holds, else 0"), crossing(&Crossings::above, "above"),
                 crossing(&Crossings::below, "below"));
  }
  void decide(const In& in, Mode& mode) const {
    mode.holds = select(holds(in.a, in.b), Real(1.0), Real(0.0));
  }
  void outputs(const Mode& mode, Out& out) const { out.y = mode.holds; }
  void crossings(const In& in, Crossings& value) const {
    value.above = above_zero(Real(in.a - in.b));
    value.below = not_below_zero(Real(in.a - in.b));
  }

 private:
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
