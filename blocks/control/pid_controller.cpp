/// v = Kp (b r - y) + Ki ∫(r - y) dt + Kd ω s/(s+ω) (c r - y),  u = v within [low, high]
///
/// With e = r - y, d = c r - y and the sample time T, `method` gives the integral I and the slope D:
///   tustin     I[k] = I[k-1] + Ki T/2 (e[k] + e[k-1]),  D[k] = ((2 - ωT) D[k-1] + 2 ω (d[k] - d[k-1])) / (2
///   + ωT) forward    I[k] = I[k-1] + Ki T e[k-1],             D[k] = (1 - ωT) D[k-1] + ω (d[k] - d[k-1]), ωT
///   < 2 backward   I[k] = I[k-1] + Ki T e[k],               D[k] = (D[k-1] + ω (d[k] - d[k-1])) / (1 + ωT)
/// and u[k] = Kp (b r[k] - y[k]) + I[k] + Kd D[k]. Before the first sample r and y are
/// `initial_measured`, at rest: e and D are 0.
///
/// Anti-windup, while v is outside the limits: "back_calculation" changes the integral at the rate
/// tracking_gain · (u - v), with tracking_gain in 1/s; "clamping" stops the integral where the error would
/// drive v further out. Parallel form with setpoint weights b and c after K. J. Åström, T. Hägglund, Advanced
/// PID Control (2006), sections 3.3 to 3.5.
#include "blocks/control/command_limits.h"
#include "models/signal/first_order.h"

namespace loopwright::blocks {

enum class Discretisation { tustin, forward, backward };
constexpr auto names_of(Discretisation) {
  return std::array<std::string_view, 3>{"tustin", "forward", "backward"};
}

template <class Real> struct PidController {
  Real Kp, Ki, Kd, derivative_pole, b = 1.0, c = 1.0, low = -infinity, high = infinity, tracking_gain = 0.0,
                                    initial = 0.0, initial_measured = 0.0;
  AntiWindup anti_windup = AntiWindup::clamping;
  Discretisation method = Discretisation::tustin;
  TustinDerivative<Real> filter;
  Real integral_step, tracked;  // Ki T, or Ki T/2 of Tustin's rule; fraction of the excess removed from the
                                // integral per sample
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
        parameter(
            &PidController::initial_measured, "initial_measured", "$signal",
            "Reference and measured signal before the start, at rest: the derivative acts on the change from "
            "there")
            .optional(),
        parameter(&PidController::method, "method", "", "How the integral and the derivative are discretised")
            .optional(),
        input(&In::reference, "reference", "$signal", "What is wanted"),
        input(&In::measured, "measured", "$signal", "What is"),
        output(&Out::command, "command", "$command", "What to do about it"));
  }
  void check(const Checker& checker) const { check_limits(checker, low, high, anti_windup, tracking_gain); }
  Fault prepare(double sample_time) {
    filter = TustinDerivative<Real>::of(derivative_pole, sample_time);
    integral_step = 0.5 * sample_time * Ki;
    const Real turn = derivative_pole * sample_time;
    if (method != Discretisation::tustin) {
      integral_step = sample_time * Ki;
      filter = method == Discretisation::forward
                   ? TustinDerivative<Real>{1.0 - turn, derivative_pole}
                   : TustinDerivative<Real>{1.0 / (1.0 + turn), derivative_pole / (1.0 + turn)};
    }
    tracked = 1.0 - exponential(-tracking_gain * sample_time);
    return fault_if((turn >= 2.0) & MaskOf<Real>(method == Discretisation::forward),
                    "the forward rule is unstable: derivative_pole times sample_time must be below 2");
  }
  void start(Memory& memory) const {
    memory.integral = initial;
    memory.signal = (c - 1.0) * initial_measured;
  }
  Memory next(const In& in, const Memory& memory) const {
    const Real error = in.reference - in.measured, signal = c * in.reference - in.measured;
    const Real added = method == Discretisation::tustin    ? error + memory.error
                       : method == Discretisation::forward ? memory.error
                                                           : error;
    const Real integral = memory.integral + integral_step * added;
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
