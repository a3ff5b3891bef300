/// F = F₊ + B₊ v while sliding forward, -F₋ + B₋ v backward; F = applied + (m/T) v, within -F₋ … F₊, while
/// stuck
#include "blocks/math/sides.h"
#include "models/friction/stiction.h"

namespace loopwright::blocks {

/// Direction-dependent dry and viscous friction, as of a preloaded screw or a one-sided seal, with true
/// sticking (models/friction/stiction.h). For `applied` and the settling time see CoulombFriction. With both
/// levels 0 (the default) it is viscous only. A damping may be negative: beside a separate viscous friction
/// it is then the reduction in one direction.
template <class Real> struct DirectionDependentFriction {
  Real level_forward = 0.0, level_backward = 0.0, damping_forward, damping_backward, mass = 1.0,
       settling_time = 1e-3;
  Stiction<Real> stiction;
  struct In {
    Real velocity, applied;
  };
  struct Out {
    Real force;
  };
  struct Mode {
    Real direction;
  };
  struct Crossings {
    Real margin;
  };
  static constexpr auto describe() {
    using B = DirectionDependentFriction;
    return block(
        "Friction that differs with the direction of motion; subtract it in the sum of forces.",
        parameter(&B::level_forward, "level_forward", "$force", "Dry friction when moving forward")
            .not_negative()
            .optional(),
        parameter(&B::level_backward, "level_backward", "$force", "Dry friction when moving backward")
            .not_negative()
            .optional(),
        parameter(&B::damping_forward, "damping_forward", "$force*s/$position", "Force per speed forward"),
        parameter(&B::damping_backward, "damping_backward", "$force*s/$position", "Force per speed backward"),
        parameter(&B::mass, "mass", "$force*s^2/$position", "Moving mass, needed where there is dry friction")
            .positive()
            .optional(),
        parameter(&B::settling_time, "settling_time", "s",
                  "Time constant with which the velocity comes to rest; not below a fixed solver step")
            .positive()
            .optional(),
        input(&In::velocity, "velocity", "$position/s", "Velocity of the moving part"),
        input(&In::applied, "applied", "$force", "Sum of all other forces on the mass").otherwise(0.0),
        output(&Out::force, "force", "$force", "Friction, positive when moving forward: to be subtracted"),
        crossing(&Crossings::margin, "sticking or breaking away", Crossing::falling));
  }
  void check(const Checker& checker) const {
    if (level_forward == 0 && level_backward == 0) return;
    if (checker.settings().find("mass")) return;
    auto& p = checker.error("level_forward", "dry friction needs the moving mass to bring it to rest");
    p.expected = "a parameter \"mass\"";
  }
  void prepare(double) { stiction = {level_forward, level_backward, mass / settling_time}; }
  Fault decide(const In& in, Mode& mode) const {
    mode.direction = stiction.next_direction(mode.direction, in.velocity, in.applied);
    return fault_if_nan(in.velocity, in.applied);
  }
  void outputs(const In& in, const Mode& mode, Out& out) const {
    const Real viscous = select(in.velocity > 0.0, damping_forward, damping_backward) * in.velocity;
    const Real sliding = select(mode.direction > 0.0, level_forward, -level_backward);
    out.force =
        viscous + select(mode.direction == 0.0, stiction.holding_force(in.velocity, in.applied), sliding);
  }
  void crossings(const In& in, const Mode& mode, Crossings& value) const {
    value.margin = not_below_zero(stiction.margin(mode.direction, in.velocity, in.applied));
  }
};
LOOPWRIGHT_BLOCK(DirectionDependentFriction)

}  // namespace loopwright::blocks
