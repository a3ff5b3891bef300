/// y[k] = (u[k] - u[k-1]) / T
///
/// An encoder step of δ appears as δ/T; VelocityEstimator filters.
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct DiscreteDerivative {
  Real initial = 0.0;
  double per_sample_time = 0;
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
    return block(
        "The change of a signal since the last sample, per time.",
        parameter(&DiscreteDerivative::initial, "initial", "$u", "Value of the signal before the start")
            .optional(),
        input(&In::u, "u", "$u", "Signal"), output(&Out::y, "y", "$u/s", "Its rate of change"));
  }
  void prepare(double sample_time) { per_sample_time = 1.0 / sample_time; }
  void start(Memory& memory) const { memory.last = initial; }
  void outputs(const In& in, const Memory& memory, Out& out) const {
    out.y = (in.u - memory.last) * per_sample_time;
  }
  void update(const In& in, Memory& memory) const { memory.last = in.u; }
};
LOOPWRIGHT_BLOCK(DiscreteDerivative)

}  // namespace loopwright::blocks
