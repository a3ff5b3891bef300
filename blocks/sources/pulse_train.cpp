/// y = high for start + k · period ≤ t < start + k · period + width, k = 0, 1 …, else low
#include "blocks/sources/turns.h"

namespace loopwright::blocks {

template <class Real> struct PulseTrain {
  Real period, width, start_time = 0.0, low = 0.0, high = 1.0;
  Periods<Real> periods;
  Real width_in_units;
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
  void prepare(double) {
    periods.start = start_time, periods.period = period, width_in_units = width;
    Real* const all[] = {&periods.start, &periods.period, &width_in_units};
    periods.units = to_counts<Real>(all);
  }
  void decide(const Instant& now, Mode& mode) const {
    const Real cycle = periods.at(Real(now.time)), fall = periods.time(cycle, width_in_units);
    mode.is_high = select((cycle >= 0.0) & (Real(now.time) < fall), Real(1.0), Real(0.0));
  }
  void outputs(const Mode& mode, Out& out) const { out.y = select(mode.is_high > 0.5, high, low); }
  double next_stop(double now) const {
    const double cycle = std::max(-1.0, lane(periods.at(Real(now)), 0));
    const double fall = lane(periods.time(Real(cycle), width_in_units), 0);
    return cycle >= 0.0 && fall > now ? fall : lane(periods.time(Real(cycle + 1.0)), 0);
  }
};
LOOPWRIGHT_BLOCK(PulseTrain)

}  // namespace loopwright::blocks
