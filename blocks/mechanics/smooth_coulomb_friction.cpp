/// F = F₀ tanh(v / v₀)
#include "engine/block.h"

namespace loopwright::blocks {

/// Smooth, so it costs solvers little, and it is accurate while sliding. It cannot hold: under a force below
/// F₀ the mass creeps. CoulombFriction holds.
template <class Real> struct SmoothCoulombFriction {
  Real level, transition_speed;
  Real per_speed;
  struct In {
    Real velocity;
  };
  struct Out {
    Real force;
  };
  static constexpr auto describe() {
    return block(
        "Dry friction whose sign changes smoothly over a small speed; subtract it in the sum of forces.",
        parameter(&SmoothCoulombFriction::level, "level", "$force", "Friction while sliding").not_negative(),
        parameter(&SmoothCoulombFriction::transition_speed, "transition_speed", "$position/s",
                  "Speed at which friction has reached 76 % of its level")
            .positive(),
        input(&In::velocity, "velocity", "$position/s", "Velocity of the moving part"),
        output(&Out::force, "force", "$force", "Friction, positive when moving forward: to be subtracted"));
  }
  void prepare(double) { per_speed = 1.0 / transition_speed; }
  void outputs(const In& in, Out& out) const {
    out.force = level * hyperbolic_tangent(in.velocity * per_speed);
  }
};
LOOPWRIGHT_BLOCK(SmoothCoulombFriction)

}  // namespace loopwright::blocks
