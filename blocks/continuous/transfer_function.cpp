/// Y(s)/U(s) = (b₀ sⁿ + … + bₙ) / (a₀ sⁿ + … + aₙ)
///
/// The block has direct feedthrough, so it cannot be part of a loop without another state. For a numerator of
/// lower degree than the denominator use StrictlyProperTransferFunction, which can. The states are in
/// controllable canonical form. From about the sixth order on, split the function into factors of low order,
/// whose coefficients do not cancel.
#include "engine/block.h"
#include "models/signal/canonical_form.h"

namespace loopwright::blocks {

template <class Real> struct TransferFunction {
  std::vector<Real> numerator, denominator;
  CanonicalForm<Real> form;
  struct In {
    Real u;
  };
  struct State {
    Vector<Real> z;
  };
  struct Out {
    Real y;
  };
  static constexpr auto describe() {
    return block("A linear system given by its transfer function, at rest at the start.",
                 parameter(&TransferFunction::numerator, "numerator", "$y/$u",
                           "Coefficients in s, highest power first")
                     .factor(),
                 parameter(&TransferFunction::denominator, "denominator", "",
                           "Coefficients in s, highest power first"),
                 input(&In::u, "u", "$u", "Signal"), output(&Out::y, "y", "$y", "The filtered signal"),
                 state_vector(&State::z, &TransferFunction::order));
  }
  int order() const { return int(denominator.size()) - 1; }
  void check(const Checker& checker) const {
    if (denominator.size() < 2) {
      checker.error("denominator", "a transfer function without a power of s has no state").hint =
          "use a Gain";
    } else if (!any(denominator[0] != 0.0)) {
      checker.error("denominator", "the highest power of s has the coefficient zero").hint = "leave it out";
    }
    if (numerator.empty() || numerator.size() > denominator.size()) {
      auto& p = checker.error("numerator", "the transfer function is not proper");
      p.expected =
          "one to as many coefficients as the denominator has, " + std::to_string(denominator.size());
      p.found = std::to_string(numerator.size());
      p.hint = "to differentiate, use the block Derivative";
    }
  }
  void prepare(double) { form = CanonicalForm<Real>::of(numerator, denominator); }
  void outputs(const In& in, const State& state, Out& out) const {
    out.y = form.outputs(state.z) + form.direct * in.u;
  }
  void derivatives(const In& in, const State& state, State& rate) const { form.rates(in.u, state.z, rate.z); }
};
LOOPWRIGHT_BLOCK(TransferFunction)

}  // namespace loopwright::blocks
