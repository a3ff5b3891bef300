/// y = initial + slope · (t - start) for start ≤ t < stop, constant before and after
#include "engine/block.h"
#include "models/real/exact_times.h"

namespace loopwright::blocks {

template <class Real> struct Ramp {
  Real slope, start_time = 0.0, stop_time = infinity, initial = 0.0;
  Real begin, end;  // s, exact
  struct Out {
    Real y;
  };
  struct Mode {
    Real has_started, has_stopped;
  };
  static constexpr auto describe() {
    return block(
        "Rises or falls steadily between two times.",
        parameter(&Ramp::slope, "slope", "$y/s", "Rise per second"),
        parameter(&Ramp::start_time, "start", "s", "When it begins to rise").optional(),
        parameter(&Ramp::stop_time, "stop", "s", "When it stops rising; never when left out").optional(),
        parameter(&Ramp::initial, "initial", "$y", "Value before").optional(),
        output(&Out::y, "y", "$y", "The ramp"));
  }
  void check(const Checker& checker) const {
    if (start_time <= stop_time) return;
    checker.error("stop", "the ramp stops before it starts").expected = "start <= stop";
  }
  void prepare(double) { begin = exact_time(start_time), end = exact_time(stop_time); }
  void decide(const Instant& now, Mode& mode) const {
    mode.has_started = select(Real(now.time) >= begin, Real(1.0), Real(0.0));
    mode.has_stopped = select(Real(now.time) >= end, Real(1.0), Real(0.0));
  }
  void outputs(const Instant& now, const Mode& mode, Out& out) const {
    const Real until = select(mode.has_stopped > 0.5, end, Real(now.time));
    out.y = initial + select(mode.has_started > 0.5, slope * (until - begin), Real(0.0));
  }
  double next_stop(double now) const {
    for (double time : {lane(begin, 0), lane(end, 0)})
      if (time > now) return time;
    return infinity;
  }
};
LOOPWRIGHT_BLOCK(Ramp)

}  // namespace loopwright::blocks
