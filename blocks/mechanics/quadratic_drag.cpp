/// F = c v |v|
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct QuadraticDrag {
  Real drag;
  struct In {
    Real velocity;
  };
  struct Out {
    Real force;
  };
  static constexpr auto describe() {
    return block(
        "Resistance that grows with the square of speed, as of air; subtract it in the sum of forces.",
        parameter(&QuadraticDrag::drag, "drag", "$force*s^2/$position^2", "Force per squared speed")
            .not_negative(),
        input(&In::velocity, "velocity", "$position/s", "Velocity of the moving part"),
        output(&Out::force, "force", "$force", "Drag, positive when moving forward: to be subtracted"));
  }
  void outputs(const In& in, Out& out) const { out.force = drag * in.velocity * absolute(in.velocity); }
};
LOOPWRIGHT_BLOCK(QuadraticDrag)

}  // namespace loopwright::blocks
