/// x[k+1] = A x[k] + B u[k],  y[k] = C x[k] + D u[k]
#include "blocks/continuous/state_space_check.h"

namespace loopwright::blocks {

template <class Real> struct DiscreteStateSpace {
  MatrixRows<Real> A, B, C, D;
  std::vector<Real> initial;
  struct In {
    Vector<const Real> u;
  };
  struct Memory {
    Vector<Real> x, next;
  };
  struct Out {
    Vector<Real> y;
  };
  static constexpr auto describe() {
    return block(
        "A sampled linear system given by four matrices, each a list of rows.",
        parameter(&DiscreteStateSpace::A, "A", "", "How the states act on the next, states by states"),
        parameter(&DiscreteStateSpace::B, "B", "", "How the inputs act on the next states, states by inputs"),
        parameter(&DiscreteStateSpace::C, "C", "$y/$u", "What of the states shows, outputs by states")
            .factor(),
        parameter(&DiscreteStateSpace::D, "D", "$y/$u", "What of the inputs shows at once, outputs by inputs")
            .factor(),
        parameter(&DiscreteStateSpace::initial, "initial", "$u", "States at the start; zeros when left out")
            .optional(),
        input(&In::u, "u", "$u", "Inputs").length(&DiscreteStateSpace::inputs),
        output(&Out::y, "y", "$y", "Outputs").length(&DiscreteStateSpace::results),
        buffer(&Memory::x, &DiscreteStateSpace::states), buffer(&Memory::next, &DiscreteStateSpace::states));
  }
  int states() const { return int(A.size()); }
  int inputs() const { return columns_of(B); }
  int results() const { return int(C.size()); }
  void check(const Checker& checker) const { check_state_space(checker, A, B, C, &D, initial); }
  void start(Memory& memory) const {
    for (size_t i = 0; i < memory.x.size(); ++i) memory.x[i] = initial.empty() ? Real(0.0) : initial[i];
  }
  void outputs(const In& in, const Memory& memory, Out& out) const {
    for (size_t i = 0; i < out.y.size(); ++i)
      out.y[i] = inner_product<Real>(C[i], memory.x) + inner_product<Real>(D[i], in.u);
  }
  void update(const In& in, Memory& memory) const {
    for (size_t i = 0; i < memory.x.size(); ++i)
      memory.next[i] = inner_product<Real>(A[i], memory.x) + inner_product<Real>(B[i], in.u);
    for (size_t i = 0; i < memory.x.size(); ++i) memory.x[i] = memory.next[i];
  }
};
LOOPWRIGHT_BLOCK(DiscreteStateSpace)

}  // namespace loopwright::blocks
