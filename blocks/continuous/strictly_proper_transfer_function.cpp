/// Y(s)/U(s) = (b₁ sⁿ⁻¹ + … + bₙ) / (a₀ sⁿ + … + aₙ)
///
/// The output depends only on the states: the block may be part of a loop. It is a type separate from
/// TransferFunction because feedthrough is a property of the type, known before the coefficients. The states
/// are in controllable canonical form. From about the sixth order on, split the function into factors of low
/// order.
#include "engine/block.h"
#include "models/signal/canonical_form.h"

namespace loopwright::blocks {

template <class Real> struct StrictlyProperTransferFunction {
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
    using B = StrictlyProperTransferFunction;
    return block(
        "A linear system whose numerator has a lower degree than its denominator, at rest at the start.",
        parameter(&B::numerator, "numerator", "$y/$u", "Coefficients in s, highest power first").factor(),
        parameter(&B::denominator, "denominator", "", "Coefficients in s, highest power first"),
        input(&In::u, "u", "$u", "Signal"), output(&Out::y, "y", "$y", "The filtered signal").from_memory(),
        state_vector(&State::z, &B::order));
  }
  int order() const { return int(denominator.size()) - 1; }
  void check(const Checker& checker) const {
    if (denominator.size() < 2) {
      checker.error("denominator", "a transfer function without a power of s has no state").hint =
          "use a Gain";
    } else if (!any(denominator[0] != 0.0)) {
      checker.error("denominator", "the highest power of s has the coefficient zero").hint = "leave it out";
    }
    if (numerator.empty() || numerator.size() >= denominator.size()) {
      auto& p = checker.error("numerator", "the transfer function is not strictly proper");
      p.expected = "at least one coefficient and fewer than the denominator has, " +
                   std::to_string(denominator.size());
      p.found = std::to_string(numerator.size());
      p.hint = "with equal degrees use the block TransferFunction";
    }
  }
  void prepare(double) { form = CanonicalForm<Real>::of(numerator, denominator); }
  void outputs(const State& state, Out& out) const { out.y = form.outputs(state.z); }
  void derivatives(const In& in, const State& state, State& rate) const { form.rates(in.u, state.z, rate.z); }
};
LOOPWRIGHT_BLOCK(StrictlyProperTransferFunction)

}  // namespace loopwright::blocks
