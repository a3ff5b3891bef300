/// y[k] = y[k-1] + (u[k] - y[k-1], no more than rising · T and no less than -falling · T)
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct RateLimiter {
  Real rising, falling, initial = 0.0;
  Real step_up, step_down;
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  struct Memory {
    Real last;
  };
  static constexpr auto describe() {
    return block(
        "Follows a signal no faster than its limits allow, sampled.",
        parameter(&RateLimiter::rising, "rising", "$u/s", "Greatest speed upwards").not_negative(),
        parameter(&RateLimiter::falling, "falling", "$u/s", "Greatest speed downwards").not_negative(),
        parameter(&RateLimiter::initial, "initial", "$u", "Output before the start").optional(),
        input(&In::u, "u", "$u", "Signal"), output(&Out::y, "y", "$u", "The signal, limited in speed"));
  }
  void prepare(double sample_time) {
    step_up = rising * sample_time;
    step_down = falling * sample_time;
  }
  void start(Memory& memory) const { memory.last = initial; }
  Real limited(const In& in, const Memory& memory) const {
    return minimum(maximum(in.u, memory.last - step_down), memory.last + step_up);
  }
  void outputs(const In& in, const Memory& memory, Out& out) const { out.y = limited(in, memory); }
  void update(const In& in, Memory& memory) const { memory.last = limited(in, memory); }
};
LOOPWRIGHT_BLOCK(RateLimiter)

}  // namespace loopwright::blocks
