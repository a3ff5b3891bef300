/// Y/U = (ω/(s+ω))ⁿ, by Tustin's rule
///
/// The DC gain is exactly 1: a constant passes unchanged. The group delay at low frequencies is n/ω.
#include "engine/block.h"
#include "models/signal/first_order.h"

namespace loopwright::blocks {

template <class Real> struct QFilter {
  Real cutoff, initial = 0.0;
  int relative_degree = 2;
  TustinLag<Real> lag;
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  struct Memory {
    Real signal[5];
  };  // the input, then the output of each lag
  static constexpr auto describe() {
    return block(
        "The low-pass filter of a disturbance observer, sampled.",
        parameter(&QFilter::cutoff, "cutoff", "rad/s", "Corner of each of the equal lags").positive(),
        parameter(&QFilter::relative_degree, "relative_degree", "", "Number of lags")
            .between(1, 4)
            .optional(),
        parameter(&QFilter::initial, "initial", "$u", "Input and output before the start").optional(),
        input(&In::u, "u", "$u", "Signal"), output(&Out::y, "y", "$u", "The filtered signal"));
  }
  void prepare(double sample_time) { lag = TustinLag<Real>::of(cutoff, sample_time); }
  void start(Memory& memory) const {
    for (Real& value : memory.signal) value = initial;
  }
  Memory next(const In& in, const Memory& last) const {
    Memory now = last;
    now.signal[0] = in.u;
    for (int i = 1; i <= relative_degree; ++i)
      now.signal[i] = lag.next(now.signal[i - 1], last.signal[i - 1], last.signal[i]);
    return now;
  }
  void outputs(const In& in, const Memory& memory, Out& out) const {
    out.y = next(in, memory).signal[relative_degree];
  }
  void update(const In& in, Memory& memory) const { memory = next(in, memory); }
};
LOOPWRIGHT_BLOCK(QFilter)

}  // namespace loopwright::blocks
