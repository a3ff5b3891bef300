/// dy/dt = u, held inside its limits, set to `initial` when `reset` rises through zero
#include "blocks/math/sides.h"

namespace loopwright::blocks {

template <class Real> struct Integrator {
  Real initial = 0.0, low = -infinity, high = infinity;
  struct In {
    Real u, reset, reset_value;
  };
  struct State {
    Real y;
  };
  struct Mode {
    Real trigger_is_high, fires, at_low, at_high;
  };
  struct Crossings {
    Real reset, low, high, release;
  };
  static constexpr auto describe() {
    return block("Integrates a signal over time, with limits and reset.",
                 parameter(&Integrator::initial, "initial", "$y", "Value at the start").optional(),
                 parameter(&Integrator::low, "low", "$y", "Lower limit").optional(),
                 parameter(&Integrator::high, "high", "$y", "Upper limit").optional(),
                 input(&In::u, "u", "$y/s", "Rate of change"),
                 input(&In::reset, "reset", "$reset", "Rising through zero sets the value").otherwise(-1.0),
                 input(&In::reset_value, "reset_value", "$y", "What reset sets the value to").otherwise(0.0),
                 output(&State::y, "y", "$y", "The integral"),
                 crossing(&Crossings::reset, "reset"),  // also its fall: only then may it rise again
                 crossing(&Crossings::low, "low", Crossing::falling),
                 crossing(&Crossings::high, "high", Crossing::rising),
                 crossing(&Crossings::release, "release"));
  }
  void check(const Checker& checker) const {
    if (low < high && initial >= low && initial <= high) return;
    auto& p = checker.error(low < high ? "initial" : "low", "the limits do not hold the initial value");
    p.expected = "low < high and low <= initial <= high";
  }
  void start(State& state) const { state.y = initial; }
  Fault decide(const In& in, const State& state, Mode& mode) const {
    const Real is_high = select(in.reset > 0.0, Real(1.0), Real(0.0));
    mode.fires = select((is_high > 0.0) & (mode.trigger_is_high < 0.5), Real(1.0), Real(0.0));
    mode.trigger_is_high = is_high;
    mode.at_low = select((state.y <= low) & (in.u < 0.0), Real(1.0), Real(0.0));
    mode.at_high = select((state.y >= high) & (in.u > 0.0), Real(1.0), Real(0.0));
    return fault_if_nan(in.reset);
  }
  void start(Mode& mode) const {
    mode.trigger_is_high = Real(1.0);
  }  // a trigger that is high at the start is no rising edge
  void jump(const In& in, const Mode& mode, State& state) const {
    const Real y = select(mode.fires > 0.5, in.reset_value, state.y);
    state.y = minimum(maximum(y, low), high);
  }
  void derivatives(const In& in, const Mode& mode, State& rate) const {
    rate.y = select((mode.at_low > 0.5) | (mode.at_high > 0.5), Real(0.0), in.u);
  }
  void crossings(const In& in, const State& state, const Mode& mode, Crossings& value) const {
    value.reset = above_zero(in.reset);
    value.low = select(mode.at_low > 0.5, Real(1.0), not_below_zero(Real(state.y - low)));
    value.high = select(mode.at_high > 0.5, Real(-1.0), above_zero(Real(state.y - high)));
    value.release = select((mode.at_low > 0.5) | (mode.at_high > 0.5), in.u, Real(1.0));
  }
};
LOOPWRIGHT_BLOCK(Integrator)

}  // namespace loopwright::blocks
