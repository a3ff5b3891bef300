/// forward: y[k] = y[k-1] + T u[k-1];  backward: y[k] = y[k-1] + T u[k];  trapezoidal: y[k] = y[k-1] + T/2
/// (u[k-1] + u[k])
///
/// In a loop, connect `before`, which does not depend on the present input; with "forward" it equals `y`. The
/// signal is taken as zero before the start. A reset sets y at its sample (with "forward" at the next sample,
/// like all inputs).
#include "blocks/math/sides.h"

namespace loopwright::blocks {

enum class IntegrationRule { forward, backward, trapezoidal };
constexpr auto names_of(IntegrationRule) {
  return std::array<std::string_view, 3>{"forward", "backward", "trapezoidal"};
}

template <class Real> struct DiscreteIntegrator {
  IntegrationRule method = IntegrationRule::trapezoidal;
  Real initial = 0.0, low = -infinity, high = infinity;
  double present = 0, past = 0;  // weights of u[k] and u[k-1], s
  struct In {
    Real u, reset, reset_value;
  };
  struct Out {
    Real y, before;
  };
  struct Memory {
    Real integral, trigger_was_high;
  };  // integral: y[k-1] + past · u[k-1]
  static constexpr auto describe() {
    return block(
        "Adds up a signal over time, sample by sample, with limits and reset.",
        parameter(&DiscreteIntegrator::method, "method", "", "How u is taken between samples").optional(),
        parameter(&DiscreteIntegrator::initial, "initial", "$y", "Value at the start").optional(),
        parameter(&DiscreteIntegrator::low, "low", "$y", "Lower limit").optional(),
        parameter(&DiscreteIntegrator::high, "high", "$y", "Upper limit").optional(),
        input(&In::u, "u", "$y/s", "Rate of change"),
        input(&In::reset, "reset", "$reset", "Rising through zero sets the value").otherwise(-1.0),
        input(&In::reset_value, "reset_value", "$y", "What reset sets the value to").otherwise(0.0),
        output(&Out::y, "y", "$y", "The integral"),
        output(&Out::before, "before", "$y", "The integral without the present input").from_memory());
  }
  void check(const Checker& checker) const {
    if (low < high && initial >= low && initial <= high) return;
    checker.error(low < high ? "initial" : "low", "the limits do not hold the initial value").expected =
        "low < high and low <= initial <= high";
  }
  void prepare(double sample_time) {
    present = (method == IntegrationRule::backward      ? 1.0
               : method == IntegrationRule::trapezoidal ? 0.5
                                                        : 0.0) *
              sample_time;
    past = sample_time - present;
  }
  void start(Memory& memory) const {
    memory = {initial, Real(1.0)};
  }  // a trigger that is high at the start is no rising edge
  Real limited(const Real& y) const { return minimum(maximum(y, low), high); }
  auto fires(const In& in, const Memory& memory) const {
    return (in.reset > 0.0) & (memory.trigger_was_high < 0.5);
  }
  Real integral(const In& in, const Memory& memory) const {
    if (method == IntegrationRule::forward) return limited(memory.integral);
    return limited(select(fires(in, memory), in.reset_value, memory.integral + present * in.u));
  }
  void outputs(const In& in, const Memory& memory, Out& out) const {
    out.before = limited(memory.integral);
    out.y = integral(in, memory);
  }
  Fault update(const In& in, Memory& memory) const {
    const Real next = integral(in, memory) + past * in.u;
    const bool is_late = method == IntegrationRule::forward;
    memory.integral = is_late ? select(fires(in, memory), in.reset_value, next) : next;
    memory.trigger_was_high = select(in.reset > 0.0, Real(1.0), Real(0.0));
    return fault_if_nan(in.reset);
  }
};
LOOPWRIGHT_BLOCK(DiscreteIntegrator)

}  // namespace loopwright::blocks
