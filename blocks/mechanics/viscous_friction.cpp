/// F = B v
#include "engine/block.h"

namespace loopwright::blocks {

/// The force is positive for motion in the positive direction, as for every block here that resists motion:
/// subtract it in the sum of forces.
template <class Real> struct ViscousFriction {
  Real damping;
  struct In {
    Real velocity;
  };
  struct Out {
    Real force;
  };
  static constexpr auto describe() {
    return block(
        "Friction proportional to speed; subtract it in the sum of forces.",
        parameter(&ViscousFriction::damping, "damping", "$force*s/$position", "Force per speed")
            .not_negative(),
        input(&In::velocity, "velocity", "$position/s", "Velocity of the moving part"),
        output(&Out::force, "force", "$force", "Friction, positive when moving forward: to be subtracted"));
  }
  void outputs(const In& in, Out& out) const { out.force = damping * in.velocity; }
};
LOOPWRIGHT_BLOCK(ViscousFriction)

}  // namespace loopwright::blocks
