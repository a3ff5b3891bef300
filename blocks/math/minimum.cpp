/// least = min(term₁, term₂, …)
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct Minimum {
  struct In {
    Many<Real> terms;
  };
  struct Out {
    Real least;
  };
  struct Mode {
    Real chosen;
  };
  struct Crossings {
    Real change;
  };
  static constexpr bool decides_anew = true;
  static constexpr auto describe() {
    return block(
        "The least of any number of signals.", input(&In::terms, "terms", "$least", "Signals of one unit"),
        output(&Out::least, "least", "$least", "The least of them"), crossing(&Crossings::change, "change"));
  }
  void outputs(const In& in, Out& out) const {
    out.least = infinity;
    for (int i = 0; i < in.terms.size(); ++i) out.least = minimum(in.terms[i], out.least);
  }
  void decide(const In& in, Mode& mode) const {
    Real least = infinity;
    mode.chosen = Real(0.0);
    for (int i = 0; i < in.terms.size(); ++i) {
      mode.chosen = select(in.terms[i] < least, Real(double(i)), mode.chosen);
      least = minimum(in.terms[i], least);
    }
  }
  /// Difference between the least of the other terms and the least term.
  void crossings(const In& in, const Mode& mode, Crossings& value) const {
    Real others = 1e300, chosen = 0.0;
    for (int i = 0; i < in.terms.size(); ++i) {
      const auto is_chosen = mode.chosen == double(i);
      others = minimum(others, select(is_chosen, Real(1e300), in.terms[i]));
      chosen = select(is_chosen, in.terms[i], chosen);
    }
    value.change = others - chosen;
  }
};
LOOPWRIGHT_BLOCK(Minimum)

}  // namespace loopwright::blocks
