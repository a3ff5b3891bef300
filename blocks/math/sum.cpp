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
    switch (in.terms.size()) {
      case 2:
        return add<2>(in.terms, out);
      case 3:
        return add<3>(in.terms, out);
      case 4:
        return add<4>(in.terms, out);
      default:
        Real sum = 0.0;
        for (int i = 0; i < in.terms.size(); ++i) sum = is_added(i) ? sum + in.terms[i] : sum - in.terms[i];
        out.sum = sum;
    }
  }

 private:
  bool is_added(int term) const { return signs.empty() || signs[size_t(term)] == '+'; }
  /// Few terms: added without a loop.
  template <int count> LW_INLINE void add(const Many<Real>& terms, Out& out) const {
    Real sum = 0.0;
#pragma GCC unroll 4
    for (int i = 0; i < count; ++i)
      if (is_added(i))
        sum = sum + terms[i];
      else
        sum = sum - terms[i];
    out.sum = sum;
  }
};
LOOPWRIGHT_BLOCK(Sum)

}  // namespace loopwright::blocks
