/// d̂ = Q Pₙ⁻¹ y - Q u,  Q = (ω/(s+ω))ⁿ,  Pₙ = 1/(M s² + B s)
///
/// Wired as DisturbanceObserver: `command` reads the limited command plus every compensation that was
/// subtracted elsewhere. Q u depends only on past commands, so the loop through the command is not an
/// algebraic loop.
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct ContinuousDisturbanceObserver {
  Real mass, damping, cutoff, initial = 0.0;
  int relative_degree = 2;
  struct In {
    Real measured, command;
  };
  struct Out {
    Real disturbance;
  };
  struct State {
    Vector<Real> lags;
  };  // of position, velocity, command, command again, estimate
  static constexpr auto describe() {
    using B = ContinuousDisturbanceObserver;
    return block(
        "Estimates the disturbance at the input of a nominal mass with viscous friction, in continuous time.",
        parameter(&B::mass, "mass", "$command*s^2/$position", "Nominal mass").positive(),
        parameter(&B::damping, "damping", "$command*s/$position", "Nominal viscous friction").not_negative(),
        parameter(&B::cutoff, "cutoff", "rad/s", "Bandwidth of the estimate").positive(),
        parameter(&B::relative_degree, "relative_degree", "", "Order of Q").between(2, 3).optional(),
        parameter(&B::initial, "initial", "$position", "Measured position before the start, at rest")
            .optional(),
        input(&In::measured, "measured", "$position", "Measured position"),
        input(&In::command, "command", "$command", "Clipped command plus compensation subtracted elsewhere"),
        output(&Out::disturbance, "disturbance", "$command", "Estimate, to be subtracted from the command")
            .from(&In::measured),
        state_vector(&State::lags, &B::order));
  }
  int order() const { return relative_degree + 2; }
  void start(State& state) const {
    for (Real& lag : state.lags) lag = 0.0;
    state.lags[0] = initial;
  }
  Real velocity(const In& in, const State& state) const { return cutoff * (in.measured - state.lags[0]); }
  Real acceleration(const In& in, const State& state) const {
    return cutoff * (velocity(in, state) - state.lags[1]);
  }
  Real second_order_estimate(const In& in, const State& state) const {
    return mass * acceleration(in, state) + damping * state.lags[1] - state.lags[3];
  }
  void outputs(const In& in, const State& state, Out& out) const {
    out.disturbance = relative_degree == 2 ? second_order_estimate(in, state) : state.lags[4];
  }
  void derivatives(const In& in, const State& state, State& rate) const {
    rate.lags[0] = velocity(in, state);
    rate.lags[1] = acceleration(in, state);
    rate.lags[2] = cutoff * (in.command - state.lags[2]);
    rate.lags[3] = cutoff * (state.lags[2] - state.lags[3]);
    if (relative_degree == 3) rate.lags[4] = cutoff * (second_order_estimate(in, state) - state.lags[4]);
  }
};
LOOPWRIGHT_BLOCK(ContinuousDisturbanceObserver)

}  // namespace loopwright::blocks
