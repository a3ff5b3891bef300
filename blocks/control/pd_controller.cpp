/// u = Kp e + Kd ω s/(s+ω) e,  e = reference - measured, by Tustin's rule
///
/// With "measurement" the derivative acts only on -measured, so that a jump of the reference gives no peak.
#include "engine/block.h"
#include "models/signal/first_order.h"

namespace loopwright::blocks {

enum class DerivativeOf { error, measurement };
constexpr auto names_of(DerivativeOf) { return std::array<std::string_view, 2>{"error", "measurement"}; }

template <class Real> struct PdController {
  Real Kp, Kd, derivative_pole, initial = 0.0;
  DerivativeOf derivative_of = DerivativeOf::error;
  TustinDerivative<Real> filter;
  struct In {
    Real reference, measured;
  };
  struct Out {
    Real command;
  };
  struct Memory {
    Real signal, slope;
  };
  static constexpr auto describe() {
    return block(
        "Proportional feedback of an error and of its filtered derivative, sampled.",
        parameter(&PdController::Kp, "Kp", "$command/$signal", "Proportional gain"),
        parameter(&PdController::Kd, "Kd", "$command*s/$signal", "Derivative gain"),
        parameter(&PdController::derivative_pole, "derivative_pole", "rad/s", "Bandwidth of the derivative")
            .positive(),
        parameter(&PdController::derivative_of, "derivative_of", "", "What is differentiated").optional(),
        parameter(&PdController::initial, "initial", "$signal", "What is differentiated, before the start")
            .optional(),
        input(&In::reference, "reference", "$signal", "What is wanted"),
        input(&In::measured, "measured", "$signal", "What is"),
        output(&Out::command, "command", "$command", "What to do about it"));
  }
  void prepare(double sample_time) { filter = TustinDerivative<Real>::of(derivative_pole, sample_time); }
  void start(Memory& memory) const { memory.signal = initial; }
  Memory next(const In& in, const Memory& memory) const {
    const Real signal = derivative_of == DerivativeOf::error ? in.reference - in.measured : -in.measured;
    return {signal, filter.next(signal, memory.signal, memory.slope)};
  }
  void outputs(const In& in, const Memory& memory, Out& out) const {
    out.command = Kp * (in.reference - in.measured) + Kd * next(in, memory).slope;
  }
  void update(const In& in, Memory& memory) const { memory = next(in, memory); }
};
LOOPWRIGHT_BLOCK(PdController)

}  // namespace loopwright::blocks
