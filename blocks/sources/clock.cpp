/// time = t
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct Clock {
  struct Out {
    Real time;
  };
  static constexpr auto describe() {
    return block("The time of the simulation.", output(&Out::time, "time", "s", "Time since the start"));
  }
  void outputs(const Instant& now, Out& out) const { out.time = now.time; }
};
LOOPWRIGHT_BLOCK(Clock)

}  // namespace loopwright::blocks
