/// y[k] = (1 - f) u[k-n] + f u[k-n-1],  slope[k] = 6 f (1 - f) (u[k-n] - u[k-n-1]),  delay = (n + f) T
#include "engine/block.h"
#include "models/real/whole.h"

namespace loopwright::blocks {

/// Between samples, y is the mean of the exactly delayed staircase. It therefore has, at every sample, the
/// same effect on an integrating plant as a held command with any delay. `slope` is the other effect on such
/// a plant: the change over one sample of the straight line with the same first moment. TransportDelay delays
/// a continuous signal.
struct FractionalDelay {
  double delay = 0, initial = 0;
  int samples = 100;
  double period = 0;  // s
  struct In {
    double u;
  };
  struct Out {
    double y, slope;
  };
  struct Memory {
    Vector<double> line;  // a ring buffer
    int64_t newest;
  };
  static constexpr auto describe() {
    return block(
        "Delays a sampled signal by any time, not only whole samples.",
        parameter(&FractionalDelay::delay, "delay", "s", "How long the signal is under way").not_negative(),
        parameter(&FractionalDelay::initial, "initial", "$u", "Output until the first of the signal arrives")
            .optional(),
        parameter(&FractionalDelay::samples, "samples", "",
                  "Longest delay that there is room for, in samples")
            .between(1, 10000000)
            .optional(),
        input(&In::u, "u", "$u", "Signal"), output(&Out::y, "y", "$u", "The signal, one delay ago"),
        output(&Out::slope, "slope", "$u",
               "Change over a sample of the straight line with the same first moment"),
        buffer(&Memory::line, &FractionalDelay::capacity));
  }
  int capacity() const { return samples + 1; }
  void prepare(double sample_time) { period = sample_time; }
  void start(Memory& memory) const {
    for (double& value : memory.line) value = initial;
    memory.newest = 0;
  }
  Fault outputs(const In& in, const Memory& memory, Out& out) const {
    const double late = in_samples();
    const int whole = whole_between(late, 0, samples);
    const double f = std::min(late - whole, 1.0);
    const double late_u = ago(in.u, memory, whole),
                 change = f > 0 ? late_u - ago(in.u, memory, whole + 1) : 0.0;
    out.y = late_u - f * change;
    out.slope = 6 * f * (1 - f) * change;
    return fault_if(late > samples,
                    "the delay is longer than there is room for: give the block more samples");
  }
  void update(const In& in, Memory& memory) const {
    memory.newest = (memory.newest + 1) % capacity();
    memory.line[size_t(memory.newest)] = in.u;
  }

 private:
  /// A delay of an integer number of samples gives an integer, although delay and period are rounded.
  double in_samples() const {
    constexpr double rounding = 1e-12;
    const double late = delay / period, whole = std::round(late);
    return std::abs(late - whole) <= rounding * whole ? whole : late;
  }
  double ago(double now, const Memory& memory, int count) const {
    if (count == 0) return now;
    return memory.line[size_t((memory.newest - (count - 1) + capacity()) % capacity())];
  }
};
LOOPWRIGHT_BLOCK(FractionalDelay)

}  // namespace loopwright::blocks
