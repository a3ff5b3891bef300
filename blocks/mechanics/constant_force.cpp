/// F = F₀
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct ConstantForce {
  Real level;
  struct Out {
    Real force;
  };
  static constexpr auto describe() {
    return block(
        "A force that is always there: gravity on a tilted axis, a pulling cable; subtract it in the sum of "
        "forces.",
        parameter(&ConstantForce::level, "level", "$force", "The force, positive when it pulls backward"),
        output(&Out::force, "force", "$force", "The force: to be subtracted"));
  }
  void outputs(Out& out) const { out.force = level; }
};
LOOPWRIGHT_BLOCK(ConstantForce)

}  // namespace loopwright::blocks
