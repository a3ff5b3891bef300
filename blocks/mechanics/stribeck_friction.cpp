/// F = ±(Fc + (Fs - Fc) exp(-(|v|/v_s)^δ)) while sliding; F = applied + (m/T) v, at most ±Fs, while stuck
#include "blocks/math/sides.h"
#include "models/friction/stiction.h"

namespace loopwright::blocks {

/// The falling Stribeck curve (Bo and Pavelescu 1982; δ = 1 Tustin, δ = 2 Gauss) with true sticking
/// (models/friction/stiction.h). For `applied` and the settling time see CoulombFriction.
template <class Real> struct StribeckFriction {
  Real level, static_level, stribeck_speed, exponent = 2.0, mass, settling_time = 1e-3;
  Real per_speed;
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
        "Dry friction that falls with speed and holds a resting mass; subtract it in the sum of forces.",
        parameter(&StribeckFriction::level, "level", "$force", "Friction at high speed").not_negative(),
        parameter(&StribeckFriction::static_level, "static_level", "$force",
                  "Friction at zero speed; starts the motion")
            .not_negative(),
        parameter(&StribeckFriction::stribeck_speed, "stribeck_speed", "$position/s",
                  "Speed over which it falls")
            .positive(),
        parameter(&StribeckFriction::exponent, "exponent", "", "Shape of the fall")
            .between(0.1, 10.0)
            .optional(),
        parameter(&StribeckFriction::mass, "mass", "$force*s^2/$position", "Moving mass, payload included")
            .positive(),
        parameter(&StribeckFriction::settling_time, "settling_time", "s",
                  "Time constant with which the velocity comes to rest; not below a fixed solver step")
            .positive()
            .optional(),
        input(&In::velocity, "velocity", "$position/s", "Velocity of the moving part"),
        input(&In::applied, "applied", "$force", "Sum of all other forces on the mass").otherwise(0.0),
        output(&Out::force, "force", "$force", "Friction, positive when moving forward: to be subtracted"),
        crossing(&Crossings::margin, "sticking or breaking away", Crossing::falling));
  }
  void check(const Checker& checker) const {
    if (static_level >= level) return;
    checker.error("static_level", "friction would rise with speed").expected = "static_level >= level";
  }
  void prepare(double) {
    per_speed = 1.0 / stribeck_speed;
    stiction = {static_level, static_level, mass / settling_time};
  }
  Fault decide(const In& in, Mode& mode) const {
    mode.direction = stiction.next_direction(mode.direction, in.velocity, in.applied);
    return fault_if_nan(in.velocity, in.applied);
  }
  void outputs(const In& in, const Mode& mode, Out& out) const {
    const Real fallen = exponential(-power(absolute(in.velocity) * per_speed, exponent));
    const Real sliding = mode.direction * (level + (static_level - level) * fallen);
    out.force = select(mode.direction == 0.0, stiction.holding_force(in.velocity, in.applied), sliding);
  }
  void crossings(const In& in, const Mode& mode, Crossings& value) const {
    value.margin = not_below_zero(stiction.margin(mode.direction, in.velocity, in.applied));
  }
};
LOOPWRIGHT_BLOCK(StribeckFriction)

}  // namespace loopwright::blocks
