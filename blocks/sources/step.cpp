/// y = before for t < time, after from then on
#include "engine/block.h"
#include "models/real/exact_times.h"

namespace loopwright::blocks {

template <class Real> struct Step {
  Real time = 0.0, before = 0.0, after = 1.0;
  Real jump_time;  // s, exact
  struct Out {
    Real y;
  };
  struct Mode {
    Real has_stepped;
  };
  static constexpr auto describe() {
    return block("Jumps from one value to another.",
                 parameter(&Step::time, "time", "s", "When it jumps").optional(),
                 parameter(&Step::before, "before", "$y", "Value before").optional(),
                 parameter(&Step::after, "after", "$y", "Value from then on").optional(),
                 output(&Out::y, "y", "$y", "The step"));
  }
  void prepare(double) { jump_time = exact_time(time); }
  void decide(const Instant& now, Mode& mode) const {
    mode.has_stepped = select(Real(now.time) >= jump_time, Real(1.0), Real(0.0));
  }
  void outputs(const Mode& mode, Out& out) const { out.y = select(mode.has_stepped > 0.5, after, before); }
  double next_stop(double now) const { return lane(jump_time, 0) > now ? lane(jump_time, 0) : infinity; }
};
LOOPWRIGHT_BLOCK(Step)

}  // namespace loopwright::blocks
