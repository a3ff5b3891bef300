/// C dT/dt = P - G (T - T_surroundings)
#include "engine/block.h"

namespace loopwright::blocks {

/// A body of one temperature: a winding, a housing, a plate. P is the heat that flows in from all sources,
/// less what flows to other nodes. A conductance between two nodes is a Sum of both temperatures and a Gain
/// in W/K. Its time constant towards the surroundings is C/G.
template <class Real> struct ThermalNode {
  Real capacity, conductance = 0.0, initial = 293.15;
  Real per_capacity;
  struct In {
    Real heat, surroundings;
  };
  struct State {
    Real temperature;
  };
  struct Out {
    Real loss;
  };
  static constexpr auto describe() {
    return block(
        "A body of one temperature that stores heat and loses some to its surroundings.",
        parameter(&ThermalNode::capacity, "capacity", "J/K", "Heat that warms it by 1 K").positive(),
        parameter(&ThermalNode::conductance, "conductance", "W/K",
                  "Heat flow to the surroundings per difference of temperature")
            .not_negative()
            .optional(),
        parameter(&ThermalNode::initial, "initial", "K", "Temperature at the start").optional(),
        input(&In::heat, "heat", "W", "Heat flow into it"),
        input(&In::surroundings, "surroundings", "K", "Temperature of the surroundings").otherwise(293.15),
        output(&State::temperature, "temperature", "K", "How warm it is"),
        output(&Out::loss, "loss", "W", "Heat flow to the surroundings").from(&In::surroundings));
  }
  void prepare(double) { per_capacity = 1.0 / capacity; }
  void start(State& state) const { state.temperature = initial; }
  Real loss(const In& in, const State& state) const {
    return conductance * (state.temperature - in.surroundings);
  }
  void outputs(const In& in, const State& state, Out& out) const { out.loss = loss(in, state); }
  void derivatives(const In& in, const State& state, State& rate) const {
    rate.temperature = (in.heat - loss(in, state)) * per_capacity;
  }
};
LOOPWRIGHT_BLOCK(ThermalNode)

}  // namespace loopwright::blocks
