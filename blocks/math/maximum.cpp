/// greatest = max(term₁, term₂, …)
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct Maximum {
  struct In {
    Many<Real> terms;
  };
  struct Out {
    Real greatest;
  };
  struct Mode {
    Real chosen;
  };
  struct Crossings {
    Real change;
  };
  static constexpr bool decides_anew = true;
  static constexpr auto describe() {
    return block("The greatest of any number of signals.",
                 input(&In::terms, "terms", "$greatest", "Signals of one unit"),
                 output(&Out::greatest, "greatest", "$greatest", "The greatest of them"),
                 crossing(&Crossings::change, "change"));
  }
  void outputs(const In& in, Out& out) const {
    out.greatest = -infinity;
    for (int i = 0; i < in.terms.size(); ++i) out.greatest = maximum(in.terms[i], out.greatest);
  }
  void decide(const In& in, Mode& mode) const {
    Real greatest = -infinity;
    mode.chosen = Real(0.0);
    for (int i = 0; i < in.terms.size(); ++i) {
      mode.chosen = select(in.terms[i] > greatest, Real(double(i)), mode.chosen);
      greatest = maximum(in.terms[i], greatest);
    }
  }
  /// Difference between the greatest term and the greatest of the others.
  void crossings(const In& in, const Mode& mode, Crossings& value) const {
    Real others = -1e300, chosen = 0.0;
    for (int i = 0; i < in.terms.size(); ++i) {
      const auto is_chosen = mode.chosen == double(i);
      others = maximum(others, select(is_chosen, Real(-1e300), in.terms[i]));
      chosen = select(is_chosen, in.terms[i], chosen);
    }
    value.change = chosen - others;
  }
};
LOOPWRIGHT_BLOCK(Maximum)

}  // namespace loopwright::blocks
