/// Y(z)/U(z) = (b₀ + b₁ z⁻¹ + …) / (a₀ + a₁ z⁻¹ + …), in transposed direct form II
///
/// The block has direct feedthrough, even if b₀ is zero. In a loop, factor out one z⁻¹ and put a UnitDelay in
/// front.
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct DiscreteTransferFunction {
  std::vector<Real> numerator, denominator, b, a;
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  struct Memory {
    Vector<Real> s;
  };
  static constexpr auto describe() {
    using B = DiscreteTransferFunction;
    return block("A linear system given by its transfer function in z, at rest at the start.",
                 parameter(&B::numerator, "numerator", "$y/$u", "Coefficients of 1, 1/z, 1/z² …").factor(),
                 parameter(&B::denominator, "denominator", "",
                           "Coefficients of 1, 1/z, 1/z² …; [1] for a finite impulse response"),
                 input(&In::u, "u", "$u", "Signal"), output(&Out::y, "y", "$y", "The filtered signal"),
                 buffer(&Memory::s, &B::order));
  }
  int order() const { return std::max(1, int(std::max(numerator.size(), denominator.size())) - 1); }
  void check(const Checker& checker) const {
    if (numerator.empty())
      checker.error("numerator", "a transfer function needs a coefficient").expected = "a number or more";
    if (denominator.empty() || !any(denominator[0] != 0.0)) {
      auto& p = checker.error("denominator", "the output itself has no coefficient");
      p.expected = "a first coefficient that is not zero";
      p.hint = "coefficients stand in rising powers of 1/z";
    }
  }
  void prepare(double) {
    b.assign(size_t(order()) + 1, Real(0.0)), a = b;
    for (size_t i = 0; i < numerator.size(); ++i) b[i] = numerator[i] / denominator[0];
    for (size_t i = 0; i < denominator.size(); ++i) a[i] = denominator[i] / denominator[0];
  }
  Real output_of(const In& in, const Memory& memory) const { return b[0] * in.u + memory.s[0]; }
  void outputs(const In& in, const Memory& memory, Out& out) const { out.y = output_of(in, memory); }
  void update(const In& in, Memory& memory) const {
    const Real y = output_of(in, memory);
    const size_t n = memory.s.size();
    for (size_t i = 0; i + 1 < n; ++i) memory.s[i] = memory.s[i + 1] + b[i + 1] * in.u - a[i + 1] * y;
    memory.s[n - 1] = b[n] * in.u - a[n] * y;
  }
};
LOOPWRIGHT_BLOCK(DiscreteTransferFunction)

}  // namespace loopwright::blocks
