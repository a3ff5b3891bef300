/// y = u (g + d (1 - exp(-(t - t0)/T))), cold until t0
#include "engine/block.h"

namespace loopwright::blocks {

/// A gain that changes as the machine warms up: the force constant of a magnet, the viscosity of grease.
template <class Real> struct ThermalDrift {
  Real drift, time_constant, cold = 1.0, start = 0.0;
  Real rate_constant;
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  static constexpr auto describe() {
    return block("Multiplies a signal by a gain that drifts from its cold to its warm value.",
                 parameter(&ThermalDrift::drift, "drift", "", "Change of the gain when warm, as a fraction"),
                 parameter(&ThermalDrift::time_constant, "time_constant", "s", "Time for 63 % of the drift")
                     .positive(),
                 parameter(&ThermalDrift::cold, "cold", "",
                           "g: gain at the start; 0 leaves only what comes with the warmth")
                     .optional(),
                 parameter(&ThermalDrift::start, "start", "s", "t0: when it begins to warm up").optional(),
                 input(&In::u, "u", "$u", "Signal"),
                 output(&Out::y, "y", "$u", "The signal with its gain drifted"));
  }
  void prepare(double) { rate_constant = 1.0 / time_constant; }
  void outputs(const Instant& now, const In& in, Out& out) const {
    const Real passed = Real(now.time) - start;
    const Real warm = select(passed > 0.0, passed, Real(0.0));
    out.y = in.u * (cold + drift * (1.0 - exponential(-warm * rate_constant)));
  }
};
LOOPWRIGHT_BLOCK(ThermalDrift)

}  // namespace loopwright::blocks
