/// y = 1 where the operator holds for its terms, else 0
///
/// "xor" holds where an odd number of terms is true, "xnor" where an even number is. "not" has one term. A
/// term is true above 0.5.
#include "blocks/logic/truth.h"

namespace loopwright::blocks {

enum class LogicOperator { all, any, negation, odd, not_all, none, even };
constexpr auto names_of(LogicOperator) {
  return std::array<std::string_view, 7>{"and", "or", "not", "xor", "nand", "nor", "xnor"};
}

template <class Real> struct Logic {
  LogicOperator combine;
  struct In {
    Many<Real> terms;
  };
  struct Out {
    Real y;
  };
  struct Mode {
    Real holds;
  };
  struct Crossings {
    Real change;
  };
  static constexpr bool decides_anew = true;
  static constexpr auto describe() {
    return block("Combines logic values.",
                 parameter(&Logic::combine, "operator", "", "How the terms are combined"),
                 input(&In::terms, "terms", "", "Logic values, true above 0.5").length(&Logic::terms),
                 output(&Out::y, "y", "", "1 where the operator holds, else 0"),
                 crossing(&Crossings::change, "change"));
  }
  int terms() const { return combine == LogicOperator::negation ? 1 : -1; }
  Fault decide(const In& in, Mode& mode) const {
    mode.holds = as_number<Real>(combined(in) > 0.0);
    MaskOf<Real> has_nan = false;
    for (int i = 0; i < in.terms.size(); ++i) has_nan = has_nan | (in.terms[i] != in.terms[i]);
    return fault_if(has_nan, "a logic value is NaN, which is neither true nor false");
  }
  void outputs(const Mode& mode, Out& out) const { out.y = mode.holds; }
  void crossings(const In& in, Crossings& value) const { value.change = combined(in); }

 private:
  /// Positive exactly where the operator holds: the least or the greatest of the terms' crossing functions,
  /// or the nearest to zero with the product of the signs.
  Real combined(const In& in) const {
    Real least = 1e300, greatest = -1e300, nearest = 1e300, parity = -1.0;  // even: -1
    for (int i = 0; i < in.terms.size(); ++i) {
      const Real term = truth_crossing(in.terms[i]);
      least = minimum(least, term), greatest = maximum(greatest, term);
      nearest = minimum(nearest, absolute(term));
      parity = select(term > 0.0, -parity, parity);
    }
    switch (combine) {
      case LogicOperator::all:
        return least;
      case LogicOperator::any:
        return greatest;
      case LogicOperator::negation:
        return -least;
      case LogicOperator::odd:
        return parity * nearest;
      case LogicOperator::not_all:
        return -least;
      case LogicOperator::none:
        return -greatest;
      case LogicOperator::even:
        return -parity * nearest;
    }
    return least;
  }
};
LOOPWRIGHT_BLOCK(Logic)

}  // namespace loopwright::blocks
