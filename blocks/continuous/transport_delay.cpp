/// y(t) = u(t - delay); before that, initial
///
/// The history consists of points at and, with a variable-step method, inside accepted solver steps. They are
/// at most delay/points apart, or as far as the step or the tolerance allows. It is interpolated linearly.
/// The error is at most gap²/8 · max|d²u/dt²|; a jump of u may be smeared over one gap. A solver step is
/// never longer than the delay. The output does not depend on the present input: the block may be part of a
/// loop.
#include "engine/block.h"

namespace loopwright::blocks {

struct TransportDelay {
  double delay = 0, initial = 0;
  int points = 1000;
  struct In {
    double u;
  };
  struct Out {
    double y;
  };
  struct Memory {
    Vector<double> time, value;  // ring buffers
    double begin;                // s
    int newest, count;
  };
  struct Mode {
    double has_arrived;
  };
  struct Crossings {
    double arrival;
  };
  static constexpr auto describe() {
    return block(
        "Delays a continuous signal by a fixed time.",
        parameter(&TransportDelay::delay, "delay", "s", "How long the signal is under way").positive(),
        parameter(&TransportDelay::initial, "initial", "$u", "Output until the first of the signal arrives")
            .optional(),
        parameter(&TransportDelay::points, "points", "", "Points of history kept within the delay")
            .between(2, 10000000)
            .optional(),
        input(&In::u, "u", "$u", "Signal"),
        output(&Out::y, "y", "$u", "The signal, one delay ago").from_memory(),
        buffer(&Memory::time, &TransportDelay::capacity), buffer(&Memory::value, &TransportDelay::capacity),
        crossing(&Crossings::arrival, "arrival", Crossing::rising));
  }
  // Of any three consecutive points the outer ones are at least delay/points apart, except at jumps.
  int capacity() const { return 2 * points + 16; }
  double until_arrival(const Instant& now, const Memory& memory) const {
    return memory.count ? (memory.begin + delay) - now.time : delay;
  }
  /// Largest rounding error of now - delay, s.
  static double rounding(const Instant& now) { return 0x1p-50 * std::abs(now.time); }
  void decide(const Instant& now, const Memory& memory, Mode& mode) const {
    mode.has_arrived = until_arrival(now, memory) <= std::max(1e-12 * delay, rounding(now)) ? 1.0 : 0.0;
  }
  void crossings(const Instant& now, const Memory& memory, const Mode& mode, Crossings& value) const {
    value.arrival = mode.has_arrived > 0.5 ? 1.0 : -until_arrival(now, memory);
  }
  double next_stop(double now) const { return now < delay ? delay : now + delay; }

  Fault outputs(const Instant& now, const Memory& memory, const Mode& mode, Out& out) const {
    out.y = initial;
    if (mode.has_arrived < 0.5) return {};
    const double wanted = now.time - delay;
    out.y = interpolate(memory, wanted, rounding(now));
    return fault_if(wanted > memory.time[size_t(memory.newest)] + 1e-6 * delay,
                    "the solver's step is longer than the delay");
  }
  Fault accept(const Instant& now, const In& in, Memory& memory) const {
    if (memory.count == 0) {
      memory.begin = now.time;
      push(memory, now.time, in.u);
      return {};
    }
    const size_t last = slot(memory, 0), before = slot(memory, 1);
    if (now.time == memory.time[last] && in.u == memory.value[last]) return {};
    const bool is_jump = now.time == memory.time[last],
               follows_jump = memory.count > 1 && memory.time[last] == memory.time[before];
    const bool last_is_spare =
        memory.count > 1 && !is_jump && !follows_jump && now.time - memory.time[before] < delay / points;
    if (last_is_spare) memory.newest = int(before), --memory.count;
    const bool is_full =
        memory.count == capacity() && memory.time[slot(memory, capacity() - 2)] > now.time - delay;
    push(memory, now.time, in.u);
    return fault_if(is_full,
                    "the signal jumps more often than the history can hold: give the block more points");
  }

 private:
  size_t slot(const Memory& memory, int back) const {
    return size_t((memory.newest - back + capacity()) % capacity());
  }
  void push(Memory& memory, double time, double value) const {
    memory.newest = memory.count ? (memory.newest + 1) % capacity() : 0;
    memory.count = std::min(memory.count + 1, capacity());
    memory.time[size_t(memory.newest)] = time, memory.value[size_t(memory.newest)] = value;
  }
  /// A time that agrees with a stored time within rounding is that time: stored values are returned
  /// unchanged.
  double interpolate(const Memory& memory, double wanted, double rounding) const {
    int near = 0, far = memory.count - 1;  // number of points back: time[near] > last >= time[far]
    if (far < 0) return initial;
    const double last = wanted + rounding;
    if (last >= memory.time[slot(memory, near)]) return memory.value[slot(memory, near)];
    if (last < memory.time[slot(memory, far)]) return memory.value[slot(memory, far)];
    while (far - near > 1) {
      const int middle = (near + far) / 2;
      (memory.time[slot(memory, middle)] > last ? near : far) = middle;
    }
    if (wanted - rounding <= memory.time[slot(memory, far)]) return memory.value[slot(memory, far)];
    const size_t a = slot(memory, far), b = slot(memory, near);
    const double weight = (wanted - memory.time[a]) / (memory.time[b] - memory.time[a]);
    return memory.value[a] + weight * (memory.value[b] - memory.value[a]);
  }
};
LOOPWRIGHT_BLOCK(TransportDelay)

}  // namespace loopwright::blocks
