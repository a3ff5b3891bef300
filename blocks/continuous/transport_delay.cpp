/// y(t) = u(t - delay),  y(t) = initial for t < delay
///
/// The history is kept at accepted solver steps, thinned to points at most delay/points or one step apart, and read by
/// straight lines: the error is at most gap²/8 · max|d²u/dt²|, and a jump of u is smeared over one gap. A solver step
/// is never longer than the delay. The output needs no present input: the block may stand in a loop.
#include "engine/block.h"

namespace loopwright::blocks {

struct TransportDelay {
  double delay = 0, initial = 0;
  int points = 1000;
  struct In { double u; };
  struct Out { double y; };
  struct Memory {
    Vector<double> time, value;  // rings
    int newest, count;
  };
  struct Mode { double has_begun; };
  static constexpr auto describe() {
    return block("Delays a continuous signal by a fixed time.",
      parameter(&TransportDelay::delay, "delay", "s", "How long the signal is under way").positive(),
      parameter(&TransportDelay::initial, "initial", "$u", "Output until the first of the signal arrives").optional(),
      parameter(&TransportDelay::points, "points", "", "Points of history kept within the delay").between(2, 10000000).optional(),
      input(&In::u, "u", "$u", "Signal"),
      output(&Out::y, "y", "$u", "The signal, one delay ago").from_memory(),
      buffer(&Memory::time, &TransportDelay::capacity), buffer(&Memory::value, &TransportDelay::capacity));
  }
  // Of any three points in a row the outer ones are at least delay/points apart; one lies beyond either end.
  int capacity() const { return 2 * points + 4; }
  void decide(const Instant& now, Mode& mode) const { mode.has_begun = now.time >= delay ? 1.0 : 0.0; }
  double next_stop(double now) const { return now < delay ? delay : now + delay; }

  Fault outputs(const Instant& now, const Memory& memory, const Mode& mode, Out& out) const {
    out.y = initial;
    if (mode.has_begun < 0.5) return {};
    const double wanted = now.time - delay;
    out.y = interpolate(memory, wanted);
    return fault_if(memory.count == 0 || wanted > memory.time[size_t(memory.newest)] + 1e-6 * delay,
                    "the solver's step is longer than the delay");
  }
  void accept(const Instant& now, const In& in, Memory& memory) const {
    if (memory.count == 0 && now.time > 0) push(memory, 0.0, in.u);  // the value at the start was not seen: the first one
    const size_t last = slot(memory, 0), before = slot(memory, 1);
    const bool last_is_spare = memory.count > 1 && now.time - memory.time[before] < delay / points;
    if (last_is_spare) memory.time[last] = now.time, memory.value[last] = in.u;
    else push(memory, now.time, in.u);
  }

 private:
  size_t slot(const Memory& memory, int back) const { return size_t((memory.newest - back + capacity()) % capacity()); }
  void push(Memory& memory, double time, double value) const {
    memory.newest = memory.count ? (memory.newest + 1) % capacity() : 0;
    memory.count = std::min(memory.count + 1, capacity());
    memory.time[size_t(memory.newest)] = time, memory.value[size_t(memory.newest)] = value;
  }
  double interpolate(const Memory& memory, double wanted) const {
    int near = 0, far = memory.count - 1;  // how far back: time[near] > wanted >= time[far]
    if (far < 0) return initial;
    if (wanted >= memory.time[slot(memory, near)]) return memory.value[slot(memory, near)];
    if (wanted < memory.time[slot(memory, far)]) return memory.value[slot(memory, far)];
    while (far - near > 1) {
      const int middle = (near + far) / 2;
      (memory.time[slot(memory, middle)] > wanted ? near : far) = middle;
    }
    const size_t a = slot(memory, far), b = slot(memory, near);
    const double weight = (wanted - memory.time[a]) / (memory.time[b] - memory.time[a]);
    return memory.value[a] + weight * (memory.value[b] - memory.value[a]);
  }
};
LOOPWRIGHT_BLOCK(TransportDelay)

}  // namespace loopwright::blocks
