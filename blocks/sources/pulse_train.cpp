/// y = high for start + k · period ≤ t < start + k · period + width, k = 0, 1 …, else low
#include "blocks/sources/turns.h"

namespace loopwright::blocks {

template <class Real> struct PulseTrain {
  Real period, width, start_time = 0.0, low = 0.0, high = 1.0;
  struct Out {
    Real y;
  };
  struct Mode {
    Real is_high;
  };
  static constexpr auto describe() {
    return block("A rectangular wave.",
                 parameter(&PulseTrain::period, "period", "s", "Time from rise to rise").positive(),
                 parameter(&PulseTrain::width, "width", "s", "How long it stays high").not_negative(),
                 parameter(&PulseTrain::start_time, "start", "s", "When it first rises").optional(),
                 parameter(&PulseTrain::low, "low", "$y", "Value between pulses").optional(),
                 parameter(&PulseTrain::high, "high", "$y", "Value in a pulse").optional(),
                 output(&Out::y, "y", "$y", "The wave"));
  }
  void check(const Checker& checker) const {
    if (width <= period) return;
    checker.error("width", "a pulse lasts longer than the period").expected = "width <= period";
  }
  void decide(const Instant& now, Mode& mode) const {
    const Real cycle = whole_periods(Real(now.time), start_time, period);
    const Real rise = start_time + cycle * period;
    mode.is_high = select((cycle >= 0.0) & (Real(now.time) < rise + width), Real(1.0), Real(0.0));
  }
  void outputs(const Mode& mode, Out& out) const { out.y = select(mode.is_high > 0.5, high, low); }
  double next_stop(double now) const {
    const double start = lane(start_time, 0), T = lane(period, 0);
    if (now < start) return start;
    const double cycle = whole_periods(now, start, T), fall = (start + cycle * T) + lane(width, 0);
    return fall > now ? fall : start + (cycle + 1.0) * T;
  }
};
LOOPWRIGHT_BLOCK(PulseTrain)

}  // namespace loopwright::blocks
