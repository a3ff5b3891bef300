/// g[k] = a g[k-1] + (1-a) w[k-1] u[k-1],  a = e^(-ωT);  w rises from 0 to `weight` during `ramp_time` after
/// `start_time`
///
/// Brings the prediction of a learned disturbance into a loop gradually, with a delay of 1/ω and one sample
/// and without an algebraic loop. Connect this output to `command` of a DisturbanceObserver too.
#include "engine/block.h"
#include "models/real/exact_times.h"

namespace loopwright::blocks {

template <class Real> struct CompensationFilter {
  Real cutoff, weight = 1.0, ramp_time = 0.0, start_time = 0.0;
  Real keep, per_ramp_time, begin;  // begin: start_time, exact
  struct In {
    Real prediction;
  };
  struct Out {
    Real compensation;
  };
  struct Memory {
    Real compensation;
  };
  static constexpr auto describe() {
    using B = CompensationFilter;
    return block("Brings a predicted disturbance into a control loop, filtered and step by step.",
                 parameter(&B::cutoff, "cutoff", "rad/s", "Bandwidth of the filter").positive(),
                 parameter(&B::weight, "weight", "", "Share of the prediction that is used in the end")
                     .not_negative()
                     .optional(),
                 parameter(&B::ramp_time, "ramp_time", "s", "Time from none to the full share")
                     .not_negative()
                     .optional(),
                 parameter(&B::start_time, "start_time", "s", "When it begins").optional(),
                 input(&In::prediction, "prediction", "$command", "Predicted disturbance"),
                 output(&Out::compensation, "compensation", "$command", "To be subtracted from the command")
                     .from_memory());
  }
  void prepare(double sample_time) {
    keep = exponential(-cutoff * sample_time);
    begin = exact_time(start_time);
    per_ramp_time = select(ramp_time > 0.0, 1.0 / maximum(ramp_time, Real(1e-300)), Real(0.0));
  }
  Real present_weight(const Instant& now) const {
    const Real elapsed = now.time - begin;
    const Real share =
        select(ramp_time > 0.0, elapsed * per_ramp_time, select(elapsed >= 0.0, Real(1.0), Real(0.0)));
    return weight * minimum(maximum(share, Real(0.0)), Real(1.0));
  }
  void outputs(const Memory& memory, Out& out) const { out.compensation = memory.compensation; }
  void update(const Instant& now, const In& in, Memory& memory) const {
    const Real wanted = present_weight(now) * in.prediction;
    memory.compensation = wanted + keep * (memory.compensation - wanted);
  }
};
LOOPWRIGHT_BLOCK(CompensationFilter)

}  // namespace loopwright::blocks
