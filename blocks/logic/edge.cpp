/// y[k] = 1 where u[k] is true and u[k-1] was false (rising), or the other way round (falling), else 0
///
/// An edge lasts for one sample, so that this block is sampled. Continuous blocks that act on an edge
/// (Counter, SampleAndHold, Integrator) find it themselves, at its exact instant. The first sample is not an
/// edge.
#include "blocks/logic/truth.h"

namespace loopwright::blocks {

template <class Real> struct Edge {
  EdgeKind kind = EdgeKind::rising;
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  struct Memory {
    Real last;
  };
  static constexpr auto describe() {
    return block("Detects the change of a logic value from one sample to the next.",
                 parameter(&Edge::kind, "edge", "", "Which change counts").optional(),
                 input(&In::u, "u", "", "Logic value, true above 0.5"),
                 output(&Out::y, "y", "", "1 for the sample at which it changes, else 0"));
  }
  void start(Memory& memory) const { memory.last = unknown_truth; }
  Fault outputs(const In& in, const Memory& memory, Out& out) const {
    out.y = as_number<Real>(is_edge<Real>(kind, memory.last, is_true(in.u)));
    return fault_unless_logic(in.u);
  }
  void update(const In& in, Memory& memory) const { memory.last = as_number<Real>(is_true(in.u)); }
};
LOOPWRIGHT_BLOCK(Edge)

}  // namespace loopwright::blocks
