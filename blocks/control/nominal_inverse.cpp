/// û = Q Pₙ⁻¹ y,  Q = (ω/(s+ω))ⁿ,  Pₙ = 1/(M s² + B s), by Tustin's rule
///
/// The command, disturbance included, that moves a nominal mass with viscous friction as measured; delayed by
/// n/ω. It starts at rest at `initial`.
#include "engine/block.h"
#include "models/signal/first_order.h"

namespace loopwright::blocks {

template <class Real> struct NominalInverse {
  Real mass, damping, cutoff, initial = 0.0;
  int relative_degree = 2;
  TustinLag<Real> lag;
  TustinDerivative<Real> derivative;
  struct In {
    Real measured;
  };
  struct Out {
    Real command;
  };
  struct Memory {
    Real measured, velocity, slow_velocity, acceleration, command, slow_command;
  };
  static constexpr auto describe() {
    return block(
        "What command would have made a nominal mass with viscous friction move as measured.",
        parameter(&NominalInverse::mass, "mass", "$command*s^2/$position", "Nominal mass").positive(),
        parameter(&NominalInverse::damping, "damping", "$command*s/$position", "Nominal viscous friction")
            .not_negative(),
        parameter(&NominalInverse::cutoff, "cutoff", "rad/s", "Bandwidth of Q").positive(),
        parameter(&NominalInverse::relative_degree, "relative_degree", "", "Order of Q")
            .between(2, 3)
            .optional(),
        parameter(&NominalInverse::initial, "initial", "$position", "Measured position before the start")
            .optional(),
        input(&In::measured, "measured", "$position", "Measured position"),
        output(&Out::command, "command", "$command", "Command with disturbance"));
  }
  void prepare(double sample_time) {
    lag = TustinLag<Real>::of(cutoff, sample_time);
    derivative = TustinDerivative<Real>::of(cutoff, sample_time);
  }
  void start(Memory& memory) const { memory.measured = initial; }
  Memory next(const In& in, const Memory& last) const {
    Memory now;
    now.measured = in.measured;
    now.velocity = derivative.next(now.measured, last.measured, last.velocity);
    now.slow_velocity = lag.next(now.velocity, last.velocity, last.slow_velocity);
    now.acceleration = derivative.next(now.velocity, last.velocity, last.acceleration);
    now.command = mass * now.acceleration + damping * now.slow_velocity;
    now.slow_command = lag.next(now.command, last.command, last.slow_command);
    return now;
  }
  void outputs(const In& in, const Memory& memory, Out& out) const {
    const Memory now = next(in, memory);
    out.command = relative_degree == 2 ? now.command : now.slow_command;
  }
  void update(const In& in, Memory& memory) const { memory = next(in, memory); }
};
LOOPWRIGHT_BLOCK(NominalInverse)

}  // namespace loopwright::blocks
