/// F = c v / (1 + (v/v_c)²)
#include "engine/block.h"

namespace loopwright::blocks {

/// Viscous below the critical speed, with a peak of c v_c / 2 at it. Above it the force falls, as the induced
/// currents shield themselves from the field (J. H. Wouterse, IEE Proc. B 138(4), 1991).
template <class Real> struct EddyCurrentDrag {
  Real damping, critical_speed;
  Real per_speed;
  struct In {
    Real velocity;
  };
  struct Out {
    Real force;
  };
  static constexpr auto describe() {
    return block(
        "Magnetic braking of a conductor in a field; subtract it in the sum of forces.",
        parameter(&EddyCurrentDrag::damping, "damping", "$force*s/$position", "Force per speed at low speed")
            .not_negative(),
        parameter(&EddyCurrentDrag::critical_speed, "critical_speed", "$position/s",
                  "Speed of the greatest force")
            .positive(),
        input(&In::velocity, "velocity", "$position/s", "Velocity of the moving part"),
        output(&Out::force, "force", "$force", "Drag, positive when moving forward: to be subtracted"));
  }
  void prepare(double) { per_speed = 1.0 / critical_speed; }
  void outputs(const In& in, Out& out) const {
    const Real ratio = in.velocity * per_speed;
    out.force = damping * in.velocity / (1.0 + ratio * ratio);
  }
};
LOOPWRIGHT_BLOCK(EddyCurrentDrag)

}  // namespace loopwright::blocks
