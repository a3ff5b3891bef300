/// dF/dx = (Fc / x_c) (1 - (F / Fc) sign v),  that is  dz/dt = (v - |v| z) / x_c,  F = Fc z
#include "engine/block.h"

namespace loopwright::blocks {

/// Hysteresis in position: after a reversal, friction approaches its other value as exp(-|Δx| / x_c), at any
/// speed. P. R. Dahl, "A Solid Friction Model", Aerospace Corporation, 1968. It holds a mass at rest like a
/// spring of stiffness Fc/x_c. For a fixed step, this spring must not be too stiff for the moving mass
/// (Fc/x_c h² ≪ m), and |v|/x_c must not be too large (|v| h < 2 x_c with rk4).
template <class Real> struct DahlFriction {
  Real level, transition_distance;
  Real per_distance;
  struct In {
    Real velocity;
  };
  struct State {
    Real fraction;
  };
  struct Out {
    Real force;
  };
  static constexpr auto describe() {
    return block(
        "Dry friction with hysteresis in position (Dahl); subtract it in the sum of forces.",
        parameter(&DahlFriction::level, "level", "$force", "Friction while sliding").not_negative(),
        parameter(&DahlFriction::transition_distance, "transition_distance", "$position",
                  "x_c: distance after a reversal over which all but 37 % of the change has happened")
            .positive(),
        input(&In::velocity, "velocity", "$position/s", "Velocity of the moving part"),
        output(&Out::force, "force", "$force", "Friction, positive when moving forward: to be subtracted")
            .from_memory(),
        output(&State::fraction, "fraction", "", "Friction as a fraction of its level, from -1 to 1"));
  }
  void prepare(double) { per_distance = 1.0 / transition_distance; }
  void derivatives(const In& in, const State& state, State& rate) const {
    rate.fraction = (in.velocity - absolute(in.velocity) * state.fraction) * per_distance;
  }
  void outputs(const State& state, Out& out) const { out.force = level * state.fraction; }
};
LOOPWRIGHT_BLOCK(DahlFriction)

}  // namespace loopwright::blocks
