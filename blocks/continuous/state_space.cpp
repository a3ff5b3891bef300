/// dx/dt = A x + B u,  y = C x + D u
///
/// D is direct feedthrough. If D is zero, use StrictlyProperStateSpace, which may be part of a loop.
#include "blocks/continuous/state_space_check.h"

namespace loopwright::blocks {

template <class Real> struct StateSpace {
  MatrixRows<Real> A, B, C, D;
  std::vector<Real> initial;
  struct In {
    Vector<const Real> u;
  };
  struct State {
    Vector<Real> x;
  };
  struct Out {
    Vector<Real> y;
  };
  static constexpr auto describe() {
    return block(
        "A linear system given by four matrices, each a list of rows.",
        parameter(&StateSpace::A, "A", "", "How the states act on their rates, states by states"),
        parameter(&StateSpace::B, "B", "", "How the inputs act on the rates, states by inputs"),
        parameter(&StateSpace::C, "C", "$y/$u", "What of the states shows, outputs by states").factor(),
        parameter(&StateSpace::D, "D", "$y/$u", "What of the inputs shows at once, outputs by inputs")
            .factor(),
        parameter(&StateSpace::initial, "initial", "$u", "States at the start; zeros when left out")
            .optional(),
        input(&In::u, "u", "$u", "Inputs").length(&StateSpace::inputs),
        output(&Out::y, "y", "$y", "Outputs").length(&StateSpace::results),
        state_vector(&State::x, &StateSpace::states));
  }
  int states() const { return int(A.size()); }
  int inputs() const { return columns_of(B); }
  int results() const { return int(C.size()); }
  void check(const Checker& checker) const { check_state_space(checker, A, B, C, &D, initial); }
  void start(State& state) const {
    for (size_t i = 0; i < state.x.size(); ++i) state.x[i] = initial.empty() ? Real(0.0) : initial[i];
  }
  void outputs(const In& in, const State& state, Out& out) const {
    for (size_t i = 0; i < out.y.size(); ++i)
      out.y[i] = inner_product<Real>(C[i], state.x) + inner_product<Real>(D[i], in.u);
  }
  void derivatives(const In& in, const State& state, State& rate) const {
    for (size_t i = 0; i < rate.x.size(); ++i)
      rate.x[i] = inner_product<Real>(A[i], state.x) + inner_product<Real>(B[i], in.u);
  }
};
LOOPWRIGHT_BLOCK(StateSpace)

}  // namespace loopwright::blocks
