/// y[k] = u[k-n],  y[k] = initial for k < n
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct Delay {
  int samples = 1;
  Real initial = 0.0;
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  struct Memory {
    Vector<Real> line;
    int64_t oldest;
  };
  static constexpr auto describe() {
    return block(
        "Delays a signal by a number of samples.",
        parameter(&Delay::samples, "samples", "", "How many samples").between(1, 10000000),
        parameter(&Delay::initial, "initial", "$u", "Output until the first sample arrives").optional(),
        input(&In::u, "u", "$u", "Signal"),
        output(&Out::y, "y", "$u", "The signal, that many samples ago").from_memory(),
        buffer(&Memory::line, &Delay::samples));
  }
  void start(Memory& memory) const {
    for (Real& value : memory.line) value = initial;
  }
  void outputs(const Memory& memory, Out& out) const { out.y = memory.line[size_t(memory.oldest)]; }
  void update(const In& in, Memory& memory) const {
    memory.line[size_t(memory.oldest)] = in.u;
    memory.oldest = memory.oldest + 1 < samples ? memory.oldest + 1 : 0;
  }
};
LOOPWRIGHT_BLOCK(Delay)

}  // namespace loopwright::blocks
