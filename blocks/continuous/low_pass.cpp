/// critically damped: Y/U = (ω/(s+ω))ⁿ;  Butterworth: |Y/U|² = 1/(1 + (w/ω)²ⁿ)
///
/// ω is the corner frequency of each factor. At ω the Butterworth filter (S. Butterworth, 1930) has gain 1/√2
/// for every order. The critically damped filter has gain 2^(-n/2), but never overshoots a step. Factors of
/// second order are cascaded.
#include "engine/block.h"

namespace loopwright::blocks {

enum class LowPassShape { butterworth, critically_damped };
constexpr auto names_of(LowPassShape) {
  return std::array<std::string_view, 2>{"butterworth", "critically_damped"};
}

template <class Real> struct LowPass {
  int order = 2;
  Real cutoff, initial = 0.0;
  LowPassShape shape = LowPassShape::butterworth;
  std::vector<double> damping;  // of each second-order factor
  struct In {
    Real u;
  };
  struct State {
    Vector<Real> x;
  };  // odd order: one lag first; then value and scaled rate of each factor
  struct Out {
    Real y;
  };
  static constexpr auto describe() {
    return block(
        "Lets slow changes of a signal pass.",
        parameter(&LowPass::order, "order", "", "How steep it is").between(1, 32).optional(),
        parameter(&LowPass::cutoff, "cutoff", "rad/s", "Where it begins to stop changes").positive(),
        parameter(&LowPass::shape, "shape", "", "Flat in frequency, or without overshoot in time").optional(),
        parameter(&LowPass::initial, "initial", "$u", "Output at the start, at rest").optional(),
        input(&In::u, "u", "$u", "Signal"), output(&Out::y, "y", "$u", "The filtered signal").from_memory(),
        state_vector(&State::x, &LowPass::order));
  }
  void prepare(double) {
    damping.assign(size_t(order / 2), 1.0);
    if (shape == LowPassShape::butterworth)
      for (size_t k = 0; k < damping.size(); ++k)
        damping[k] = sine(pi * double(2 * k + 1) / double(2 * order));
  }
  void start(State& state) const {
    for (size_t i = 0; i < state.x.size(); ++i) state.x[i] = is_value(i) ? initial : Real(0.0);
  }
  bool is_value(size_t i) const { return order % 2 ? i == 0 || i % 2 == 1 : i % 2 == 0; }
  void outputs(const State& state, Out& out) const { out.y = state.x[size_t(order == 1 ? 0 : order - 2)]; }
  void derivatives(const In& in, const State& state, State& rate) const {
    Real u = in.u;
    size_t i = 0;
    if (order % 2) rate.x[0] = cutoff * (u - state.x[0]), u = state.x[0], i = 1;
    for (const double zeta : damping) {
      const Real value = state.x[i], slope = state.x[i + 1];
      rate.x[i] = cutoff * slope;
      rate.x[i + 1] = cutoff * (u - value - 2.0 * zeta * slope);
      u = value, i += 2;
    }
  }
};
LOOPWRIGHT_BLOCK(LowPass)

}  // namespace loopwright::blocks
