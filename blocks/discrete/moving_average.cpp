/// y[k] = (u[k] + u[k-1] + … + u[k-n+1]) / n
///
/// Nothing is ever subtracted: rounding errors do not accumulate, and after n samples an outlier has no
/// effect to the last bit. The samples are processed in rounds of n. The window is the first part of this
/// round, a running sum, and the last part of the round before, one of its sums from the end (van Herk and
/// Gil-Werman, 1992). The cost is one addition per sample, and n more at the end of a round.
#include "engine/block.h"

namespace loopwright::blocks {

template <class Real> struct MovingAverage {
  int samples = 1;
  Real initial = 0.0;
  struct In {
    Real u;
  };
  struct Out {
    Real y;
  };
  struct Memory {
    Vector<Real> line;  // up to `place` the samples of this round; after it, sums from the end of the round
                        // before
    Real sum;           // of this round
    int64_t place;
  };
  static constexpr auto describe() {
    return block("The mean of the last samples of a signal, the present one included.",
                 parameter(&MovingAverage::samples, "samples", "", "How many samples").between(1, 10000000),
                 parameter(&MovingAverage::initial, "initial", "$u", "Value of the signal before the start")
                     .optional(),
                 input(&In::u, "u", "$u", "Signal"), output(&Out::y, "y", "$u", "Mean of the last samples"),
                 buffer(&Memory::line, &MovingAverage::samples));
  }
  void start(Memory& memory) const {
    for (size_t i = 0; i < memory.line.size(); ++i) memory.line[i] = double(memory.line.size() - i) * initial;
  }
  void outputs(const In& in, const Memory& memory, Out& out) const {
    const Real now = memory.sum + in.u;
    const bool is_full = memory.place + 1 == samples;
    out.y = (is_full ? now : now + memory.line[size_t(memory.place) + 1]) / double(samples);
  }
  void update(const In& in, Memory& memory) const {
    memory.line[size_t(memory.place)] = in.u;
    memory.sum = memory.sum + in.u;
    if (++memory.place < samples) return;
    for (size_t i = memory.line.size() - 1; i > 0; --i)
      memory.line[i - 1] = memory.line[i - 1] + memory.line[i];
    memory.sum = 0.0, memory.place = 0;
  }
};
LOOPWRIGHT_BLOCK(MovingAverage)

}  // namespace loopwright::blocks
