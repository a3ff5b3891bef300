/// F = z (Fc + (Fs - Fc) exp(-(|v|/v_s)^δ)),  z = s + (z₋ - s) exp(-|x - x₋|/x_c),  s = sign(x - x₋)
#include "engine/block.h"

namespace loopwright::blocks {

/// Dahl's friction in closed form between accepted steps (x₋, z₋ are the values of the last one). It is exact
/// if the motion does not reverse within a step, stable for any step and any speed, and at rest it holds
/// without creep. With a transition distance of micrometers it is Coulomb friction. With the falling Stribeck
/// curve it models dry contacts. Wire the velocity: reversals are then events for variable-step solvers.
template <class Real> struct PreslidingFriction {
  Real level, static_level = 0.0, stribeck_speed = 1.0, exponent = 2.0, transition_distance;
  Real rise, per_speed, per_distance;
  struct In {
    Real position, velocity;
  };
  struct Out {
    Real force, fraction;
  };
  struct Memory {
    Real position, fraction, has_begun;
  };
  struct Crossings {
    Real reversal;
  };
  static constexpr auto describe() {
    using B = PreslidingFriction;
    return block(
        "Dry friction with hysteresis in position, for any step; subtract it in the sum of forces.",
        parameter(&B::level, "level", "$force", "Friction while sliding fast").not_negative(),
        parameter(&B::static_level, "static_level", "$force",
                  "Friction while sliding slowly; never less than the level, so that 0 means the level")
            .not_negative()
            .optional(),
        parameter(&B::stribeck_speed, "stribeck_speed", "$position/s", "Speed over which friction falls")
            .positive()
            .optional(),
        parameter(&B::exponent, "exponent", "", "Shape of the fall").between(0.1, 10.0).optional(),
        parameter(&B::transition_distance, "transition_distance", "$position",
                  "x_c: distance after a reversal over which all but 37 % of the change has happened")
            .positive(),
        input(&In::position, "position", "$position", "Position of the moving part"),
        input(&In::velocity, "velocity", "$position/s", "Its velocity; needed for the falling curve")
            .otherwise(0.0),
        output(&Out::force, "force", "$force", "Friction, positive when moving forward: to be subtracted"),
        output(&Out::fraction, "fraction", "", "z: friction as a fraction of its level, from -1 to 1")
            .from(&In::position),
        crossing(&Crossings::reversal, "reversal"));
  }
  void prepare(double) {
    rise = maximum(static_level - level, Real(0.0));
    per_speed = 1.0 / stribeck_speed;
    per_distance = 1.0 / transition_distance;
  }
  /// [1] Of the level: so little is left to change after 28 transition distances. Rounding would keep some of
  /// it for ever, by where the motion began.
  static constexpr double nearly_nothing = 1e-12;
  Real fraction(const In& in, const Memory& memory) const {
    const Real way = in.position - memory.position;
    const Real direction = select(way < 0.0, Real(-1.0), Real(1.0));
    const Real missing = memory.fraction - direction;
    const Real change = select(absolute(missing) < nearly_nothing, Real(0.0), missing);
    // While it slides on, nothing is left to change: that needs no exponential, and has the same bits.
    const Real left = any(change != 0.0) ? exponential(-absolute(way) * per_distance) : 0.0 * way;
    return memory.has_begun * (direction + change * left);
  }
  Real sliding_level(const Real& velocity) const {
    if (!any(rise != 0.0)) return level;
    return level + rise * exponential(-raised(absolute(velocity) * per_speed));
  }
  /// To the exponent; usual are 1 and 2, and a power costs as much as all else.
  Real raised(const Real& speed) const {
    const Real square = speed * speed;
    if (!any(exponent != 2.0)) return square;
    if (!any(exponent != 1.0)) return speed;
    return select(exponent == 2.0, square, select(exponent == 1.0, speed, power(speed, exponent)));
  }
  void outputs(const In& in, const Memory& memory, Out& out) const {
    out.fraction = fraction(in, memory);
    out.force = out.fraction * sliding_level(in.velocity);
  }
  void accept(const In& in, Memory& memory) const { memory = {in.position, fraction(in, memory), 1.0}; }
  void crossings(const In& in, Crossings& value) const { value.reversal = in.velocity; }
};
LOOPWRIGHT_BLOCK(PreslidingFriction)

}  // namespace loopwright::blocks
