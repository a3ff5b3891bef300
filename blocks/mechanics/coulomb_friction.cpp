/// F = ±Fc while sliding; F = applied + (m/T) v, at most ±Fs, while stuck
#include "blocks/math/sides.h"
#include "models/friction/stiction.h"

namespace loopwright::blocks {

/// Dry friction with true sticking (models/friction/stiction.h). `applied` is the sum of all other forces on
/// the mass: driving forces positive, resisting forces negative. It must not contain this friction. If it is
/// not wired, friction can only react to the velocity: under a force F below the breakaway force the mass
/// then creeps at F T/m instead of resting. The settling time should not be shorter than a fixed solver step;
/// it is the time constant of the velocity at rest.
template <class Real> struct CoulombFriction {
  Real level, static_level = 0.0, mass, settling_time = 1e-3;
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
    return block(
        "Dry friction of constant level that holds a resting mass; subtract it in the sum of forces.",
        parameter(&CoulombFriction::level, "level", "$force", "Friction while sliding").not_negative(),
        parameter(&CoulombFriction::static_level, "static_level", "$force",
                  "Force that starts the motion; never less than the level, so that 0 means the level")
            .not_negative()
            .optional(),
        parameter(&CoulombFriction::mass, "mass", "$force*s^2/$position", "Moving mass, payload included")
            .positive(),
        parameter(&CoulombFriction::settling_time, "settling_time", "s",
                  "Time constant with which the velocity comes to rest; not below a fixed solver step")
            .positive()
            .optional(),
        input(&In::velocity, "velocity", "$position/s", "Velocity of the moving part"),
        input(&In::applied, "applied", "$force", "Sum of all other forces on the mass").otherwise(0.0),
        output(&Out::force, "force", "$force", "Friction, positive when moving forward: to be subtracted"),
        crossing(&Crossings::margin, "sticking or breaking away", Crossing::falling));
  }
  void check(const Checker& checker) const {
    if (static_level == 0 || static_level >= level) return;
    checker.error("static_level", "the motion would start at less force than it needs to go on").expected =
        "static_level >= level, or 0 for static_level = level";
  }
  void prepare(double) {
    const Real breakaway = maximum(static_level, level);
    stiction = {breakaway, breakaway, mass / settling_time};
  }
  Fault decide(const In& in, Mode& mode) const {
    mode.direction = stiction.next_direction(mode.direction, in.velocity, in.applied);
    return fault_if_nan(in.velocity, in.applied);
  }
  void outputs(const In& in, const Mode& mode, Out& out) const {
    out.force = select(mode.direction == 0.0, stiction.holding_force(in.velocity, in.applied),
                       mode.direction * level);
  }
  void crossings(const In& in, const Mode& mode, Crossings& value) const {
    value.margin = not_below_zero(stiction.margin(mode.direction, in.velocity, in.applied));
  }
};
LOOPWRIGHT_BLOCK(CoulombFriction)

}  // namespace loopwright::blocks
