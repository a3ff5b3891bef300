/// d̂ = Q Pₙ⁻¹ y - Q u,  Q = (ω/(s+ω))ⁿ,  Pₙ = 1/(M s² + B s), by Tustin's rule
///
/// Wiring. Subtract `disturbance` from the command. Connect `command` to u + g: the command sent to the plant
/// after limiting, u, plus every compensation subtracted elsewhere (a learned one, for example), g. The
/// observer and the compensation then do not both cancel the same disturbance; with a perfect g the estimate
/// goes to zero.
///
/// `command_path`. "matched": Q u is Q(z) · 2/(z+1), which fits a plant behind a zero-order hold, as its
/// samples have the same factor (z+1)/2 relative to Tustin's rule. "delayed": Q(z)/z. Both use only past
/// commands, so there is no algebraic loop. After K. Ohnishi, M. Shibata, T. Murakami, IEEE/ASME Trans.
/// Mechatronics 1 (1996).
#include "engine/block.h"
#include "models/signal/first_order.h"

namespace loopwright::blocks {

enum class CommandPath { matched, delayed };
constexpr auto names_of(CommandPath) { return std::array<std::string_view, 2>{"matched", "delayed"}; }

template <class Real> struct DisturbanceObserver {
  Real mass, damping, cutoff, initial = 0.0;
  int relative_degree = 2;
  CommandPath command_path = CommandPath::matched;
  TustinLag<Real> lag;
  TustinDerivative<Real> derivative;
  struct In {
    Real measured, command;
  };
  struct Out {
    Real disturbance;
  };
  struct Memory {
    Real measured, velocity, slow_velocity, acceleration;  // of the last sample, filtered
    Real command, command_before, slow_command, slower_command;
    Real estimate, slow_estimate;  // of second and of third order
  };
  static constexpr auto describe() {
    using B = DisturbanceObserver;
    return block(
        "Estimates the disturbance at the input of a nominal mass with viscous friction, sampled.",
        parameter(&B::mass, "mass", "$command*s^2/$position", "Nominal mass").positive(),
        parameter(&B::damping, "damping", "$command*s/$position", "Nominal viscous friction").not_negative(),
        parameter(&B::cutoff, "cutoff", "rad/s", "Bandwidth of the estimate").positive(),
        parameter(&B::relative_degree, "relative_degree", "", "Order of Q").between(2, 3).optional(),
        parameter(&B::command_path, "command_path", "",
                  "How commands are brought in step with the measurement")
            .optional(),
        parameter(&B::initial, "initial", "$position", "Measured position before the start, at rest")
            .optional(),
        input(&In::measured, "measured", "$position", "Measured position"),
        input(&In::command, "command", "$command", "Clipped command plus compensation subtracted elsewhere"),
        output(&Out::disturbance, "disturbance", "$command", "Estimate, to be subtracted from the command")
            .from(&In::measured));
  }
  void prepare(double sample_time) {
    lag = TustinLag<Real>::of(cutoff, sample_time);
    derivative = TustinDerivative<Real>::of(cutoff, sample_time);
  }
  void start(Memory& memory) const { memory.measured = initial; }
  /// The memory after this sample.
  Memory next(const In& in, const Memory& last) const {
    Memory now;
    now.measured = in.measured;
    now.velocity = derivative.next(now.measured, last.measured, last.velocity);
    now.slow_velocity = lag.next(now.velocity, last.velocity, last.slow_velocity);
    now.acceleration = derivative.next(now.velocity, last.velocity, last.acceleration);
    // A lag with both its weights on the last command means (1 + z⁻¹) → 2 z⁻¹, that is 2/(z+1).
    const Real before = command_path == CommandPath::matched ? last.command : last.command_before;
    now.slow_command = lag.next(last.command, before, last.slow_command);
    now.slower_command = lag.next(now.slow_command, last.slow_command, last.slower_command);
    now.estimate = mass * now.acceleration + damping * now.slow_velocity - now.slower_command;
    now.slow_estimate = lag.next(now.estimate, last.estimate, last.slow_estimate);
    now.command = in.command, now.command_before = last.command;
    return now;
  }
  void outputs(const In& in, const Memory& memory, Out& out) const {
    const Memory now = next(in, memory);
    out.disturbance = relative_degree == 2 ? now.estimate : now.slow_estimate;
  }
  void update(const In& in, Memory& memory) const { memory = next(in, memory); }
};
LOOPWRIGHT_BLOCK(DisturbanceObserver)

}  // namespace loopwright::blocks
