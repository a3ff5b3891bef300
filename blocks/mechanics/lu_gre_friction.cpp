/// dz/dt = κ (v - λ z),  F = σ₀ z + σ₁ dz/dt + σ₂ v,  λ = σ₀ |v| / g(v),  g(v) = Fc + (Fs - Fc)
/// exp(-(v/v_s)²)
#include "engine/block.h"

namespace loopwright::blocks {

/// Bristle model with deflection z: presliding, breakaway, Stribeck effect and frictional lag in one state.
/// C. Canudas de Wit, H. Olsson, K. J. Åström, P. Lischinsky, "A New Model for Control of Systems with
/// Friction", IEEE TAC 40(3), 1995. As published (κ = 1), the rate λ grows with speed without bound, so that
/// every explicit solver becomes unstable. Here κ = min(1, 1/(λ T)): the bristles never settle faster than T,
/// while the steady force g(v) sign(v) + σ₂ v is unchanged at every speed. κ acts only where |v| > g/(σ₀ T).
/// Choose T at least half the solver step. A small σ₁ keeps the model dissipative; σ₁ near 2 √(σ₀ m) damps
/// the bristles critically.
template <class Real> struct LuGreFriction {
  Real stiffness, bristle_damping = 0.0, damping = 0.0, level, static_level, stribeck_speed,
                  settling_time = 1e-4;
  Real per_speed, fastest;
  struct In {
    Real velocity;
  };
  struct State {
    Real deflection;
  };
  struct Out {
    Real force;
  };
  static constexpr auto describe() {
    return block(
        "Dry friction with presliding, breakaway and lag (LuGre); subtract it in the sum of forces.",
        parameter(&LuGreFriction::stiffness, "stiffness", "$force/$position",
                  "σ₀: force per deflection of the bristles")
            .positive(),
        parameter(&LuGreFriction::bristle_damping, "bristle_damping", "$force*s/$position",
                  "σ₁: damping of the bristles")
            .not_negative()
            .optional(),
        parameter(&LuGreFriction::damping, "damping", "$force*s/$position", "σ₂: viscous friction")
            .not_negative()
            .optional(),
        parameter(&LuGreFriction::level, "level", "$force", "Fc: friction at high speed").positive(),
        parameter(&LuGreFriction::static_level, "static_level", "$force", "Fs: friction at zero speed")
            .positive(),
        parameter(&LuGreFriction::stribeck_speed, "stribeck_speed", "$position/s",
                  "Speed over which it falls")
            .positive(),
        parameter(&LuGreFriction::settling_time, "settling_time", "s",
                  "T: the bristles settle no faster; at least half the solver step")
            .positive()
            .optional(),
        input(&In::velocity, "velocity", "$position/s", "Velocity of the moving part"),
        output(&Out::force, "force", "$force", "Friction, positive when moving forward: to be subtracted"),
        output(&State::deflection, "deflection", "$position", "z: mean deflection of the bristles"));
  }
  void check(const Checker& checker) const {
    if (static_level >= level) return;
    checker.error("static_level", "friction would rise with speed").expected = "static_level >= level";
  }
  void prepare(double) {
    per_speed = 1.0 / stribeck_speed;
    fastest = 1.0 / settling_time;
  }
  Real deflection_rate(const In& in, const State& state) const {
    const Real speed = absolute(in.velocity), ratio = in.velocity * per_speed;
    const Real relaxation =
        stiffness * speed / (level + (static_level - level) * exponential(-ratio * ratio));
    return select(relaxation > fastest, fastest / relaxation, Real(1.0)) *
           (in.velocity - relaxation * state.deflection);
  }
  void derivatives(const In& in, const State& state, State& rate) const {
    rate.deflection = deflection_rate(in, state);
  }
  void outputs(const In& in, const State& state, Out& out) const {
    out.force =
        stiffness * state.deflection + bristle_damping * deflection_rate(in, state) + damping * in.velocity;
  }
};
LOOPWRIGHT_BLOCK(LuGreFriction)

}  // namespace loopwright::blocks
