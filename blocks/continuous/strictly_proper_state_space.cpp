/// dx/dt = A x + B u,  y = C x
///
/// The outputs depend only on the states: the block may be part of a loop.
#include "blocks/continuous/state_space_check.h"

namespace loopwright::blocks {

template <class Real> struct StrictlyProperStateSpace {
  MatrixRows<Real> A, B, C;
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
    using Block = StrictlyProperStateSpace;
    return block(
        "A linear system given by three matrices, each a list of rows; no input acts on an output at once.",
        parameter(&Block::A, "A", "", "How the states act on their rates, states by states"),
        parameter(&Block::B, "B", "", "How the inputs act on the rates, states by inputs"),
        parameter(&Block::C, "C", "$y/$u", "What of the states shows, outputs by states").factor(),
        parameter(&Block::initial, "initial", "$u", "States at the start; zeros when left out").optional(),
        input(&In::u, "u", "$u", "Inputs").length(&Block::inputs),
        output(&Out::y, "y", "$y", "Outputs").from_memory().length(&Block::results),
        state_vector(&State::x, &Block::states));
  }
  int states() const { return int(A.size()); }
  int inputs() const { return columns_of(B); }
  int results() const { return int(C.size()); }
  void check(const Checker& checker) const { check_state_space(checker, A, B, C, nullptr, initial); }
  void start(State& state) const {
    for (size_t i = 0; i < state.x.size(); ++i) state.x[i] = initial.empty() ? Real(0.0) : initial[i];
  }
  void outputs(const State& state, Out& out) const {
    for (size_t i = 0; i < out.y.size(); ++i) out.y[i] = inner_product<Real>(C[i], state.x);
  }
  void derivatives(const In& in, const State& state, State& rate) const {
    for (size_t i = 0; i < rate.x.size(); ++i)
      rate.x[i] = inner_product<Real>(A[i], state.x) + inner_product<Real>(B[i], in.u);
  }
};
LOOPWRIGHT_BLOCK(StrictlyProperStateSpace)

}  // namespace loopwright::blocks
