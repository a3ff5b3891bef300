/// sum = ± term₁ ± term₂ …
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct Sum {
  std::string signs;
  struct In {
    Many<Real> terms;
  };
  struct Out {
    Real sum;
  };
  static constexpr auto describe() {
    return block(
        "Adds and subtracts any number of signals of one unit.",
        parameter(&Sum::signs, "signs", "", "One + or - for each term; all + when left out").optional(),
        input(&In::terms, "terms", "$sum", "What is added").length(&Sum::terms),
        output(&Out::sum, "sum", "$sum", "The signed sum"));
  }
  int terms() const { return signs.empty() ? -1 : int(signs.size()); }
  void check(const Checker& checker) const {
    if (signs.find_first_not_of("+-") == signs.npos) return;
    auto& p = checker.error("signs", "signs may only hold + and -");
    p.expected = "one + or - for each term, as in \"++-\"";
    p.found = "\"" + signs + "\"";
  }
  void outputs(const In& in, Out& out) const {
    Real sum = 0.0;
    for (int i = 0; i < in.terms.size(); ++i)
      if (signs.empty() || signs[size_t(i)] == '+')
        sum = sum + in.terms[i];
      else
        sum = sum - in.terms[i];
    out.sum = sum;
  }
};
LOOPWRIGHT_BLOCK(Sum)

}  // namespace loopwright::blocks
