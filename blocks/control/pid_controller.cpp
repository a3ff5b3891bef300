/// v = Kp (b r - y) + Ki ∫(r - y) dt + Kd ω s/(s+ω) (c r - y),  u = v within [low, high], by Tustin's rule
///
/// Anti-windup, while v is outside the limits: "back_calculation" changes the integral at the rate
/// tracking_gain · (u - v), with tracking_gain in 1/s; "clamping" stops the integral where the error would
/// drive v further out. Parallel form with setpoint weights b and c after K. J. Åström, T. Hägglund, Advanced
/// PID Control (2006), sections 3.3 to 3.5.
#include "engine/block.h"
#include "models/signal/first_order.h"

namespace loopwright::blocks {

enum class AntiWindup { none, back_calculation, clamping };
constexpr auto names_of(AntiWindup) {
  return std::array<std::string_view, 3>{"none", "back_calculation", "clamping"};
}

template <class Real> struct PidController {
  Real Kp, Ki, Kd, derivative_pole, b = 1.0, c = 1.0, low = -infinity, high = infinity, tracking_gain = 0.0,
                                    initial = 0.0;
  AntiWindup anti_windup = AntiWindup::clamping;
  TustinDerivative<Real> filter;
  Real integral_step, tracked;  // Ki T/2; fraction of the excess removed from the integral per sample
  struct In {
    Real reference, measured;
  };
  struct Out {
    Real command;
  };
  struct Memory {
    Real integral, error, signal, slope;
  };
  static constexpr auto describe() {
    return block(
        "Proportional, integral and derivative feedback with limits, sampled.",
        parameter(&PidController::Kp, "Kp", "$command/$signal", "Proportional gain"),
        parameter(&PidController::Ki, "Ki", "$command/$signal/s", "Integral gain"),
        parameter(&PidController::Kd, "Kd", "$command*s/$signal", "Derivative gain"),
        parameter(&PidController::derivative_pole, "derivative_pole", "rad/s", "Bandwidth of the derivative")
            .positive(),
        parameter(&PidController::b, "b", "", "Weight of the reference in the proportional part").optional(),
        parameter(&PidController::c, "c", "", "Weight of the reference in the derivative part").optional(),
        parameter(&PidController::low, "low", "$command", "Least command").optional(),
        parameter(&PidController::high, "high", "$command", "Greatest command").optional(),
        parameter(&PidController::anti_windup, "anti_windup", "", "What the integral does at a limit")
            .optional(),
        parameter(&PidController::tracking_gain, "tracking_gain", "1/s", "Speed of the back calculation")
            .not_negative()
            .optional(),
        parameter(&PidController::initial, "initial", "$command", "Integral part at the start").optional(),
        input(&In::reference, "reference", "$signal", "What is wanted"),
        input(&In::measured, "measured", "$signal", "What is"),
        output(&Out::command, "command", "$command", "What to do about it"));
  }
  void check(const Checker& checker) const {
    if (!(low < high)) checker.error("low", "the limits leave no room for a command").expected = "low < high";
    if (anti_windup != AntiWindup::back_calculation || tracking_gain > 0.0) return;
    auto& p = checker.error("tracking_gain", "back calculation needs a speed");
    p.expected = "a number above 0, in 1/s";
    p.hint = "Ki/Kp is a usual choice";
  }
  void prepare(double sample_time) {
    filter = TustinDerivative<Real>::of(derivative_pole, sample_time);
    integral_step = 0.5 * sample_time * Ki;
    tracked = 1.0 - exponential(-tracking_gain * sample_time);
  }
  void start(Memory& memory) const { memory.integral = initial; }
  Memory next(const In& in, const Memory& memory) const {
    const Real error = in.reference - in.measured, signal = c * in.reference - in.measured;
    const Real integral = memory.integral + integral_step * (error + memory.error);
    return {integral, error, signal, filter.next(signal, memory.signal, memory.slope)};
  }
  Real unlimited(const In& in, const Memory& now) const {
    return Kp * (b * in.reference - in.measured) + now.integral + Kd * now.slope;
  }
  Real limited(const Real& v) const { return minimum(maximum(v, low), high); }
  void outputs(const In& in, const Memory& memory, Out& out) const {
    out.command = limited(unlimited(in, next(in, memory)));
  }
  void update(const In& in, Memory& memory) const {
    Memory now = next(in, memory);
    const Real v = unlimited(in, now), excess = v - limited(v);
    if (anti_windup == AntiWindup::back_calculation) now.integral = now.integral - tracked * excess;
    const auto goes_further_out = excess * (now.integral - memory.integral) > 0.0;
    if (anti_windup == AntiWindup::clamping)
      now.integral = select(goes_further_out, memory.integral, now.integral);
    memory = now;
  }
};
LOOPWRIGHT_BLOCK(PidController)

}  // namespace loopwright::blocks
