/// product = factor₁ ×/÷ factor₂ …
///
/// Factors may have different units. Division by exactly zero stops the run; near zero the result follows
/// IEEE 754.
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct Product {
  std::string operations;
  struct In {
    Many<Real> factors;
  };
  struct Out {
    Real product;
  };
  static constexpr auto describe() {
    return block(
        "Multiplies and divides any number of signals.",
        parameter(&Product::operations, "operations", "", "One * or / for each factor; all * when left out")
            .optional(),
        input(&In::factors, "factors", "?", "What is multiplied").length(&Product::factors),
        output(&Out::product, "product", "$product", "The product"));
  }
  double unit_power(int wire) const {
    return size_t(wire) < operations.size() && operations[size_t(wire)] == '/' ? -1 : 1;
  }
  int factors() const { return operations.empty() ? -1 : int(operations.size()); }
  void check(const Checker& checker) const {
    if (operations.find_first_not_of("*/") == operations.npos) return;
    auto& p = checker.error("operations", "operations may only hold * and /");
    p.expected = "one * or / for each factor, as in \"**/\"";
    p.found = "\"" + operations + "\"";
  }
  Fault outputs(const In& in, Out& out) const {
    Real product = 1.0, divisor = 1.0;
    MaskOf<Real> has_zero = false;
    for (int i = 0; i < in.factors.size(); ++i) {
      if (operations.empty() || operations[size_t(i)] == '*')
        product = product * in.factors[i];
      else
        divisor = divisor * in.factors[i], has_zero = has_zero | (in.factors[i] == 0.0);
    }
    out.product = product / divisor;
    return fault_if(has_zero, "division by zero");
  }
};
LOOPWRIGHT_BLOCK(Product)

}  // namespace loopwright::blocks
