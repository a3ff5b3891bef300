/// v = Kp (b r - y) + I + Kd D,  u = v within [low, high], with gains that are signals, and a manual mode
///
/// With e = r - y, d = c r - y and the sample time T, as the PidController with "tustin":
///   I[k] = I[k-1] + Ki[k] T/2 (e[k] + e[k-1]),  D[k] = ((2 - ωT) D[k-1] + 2 ω (d[k] - d[k-1])) / (2 + ωT).
///
/// Gains may change at any sample, from a table or a switch, without a bump: before a sample is computed, I
/// takes up what the new gains change in the command of the last one,
///   I[k-1] += (Kp[k-1] - Kp[k]) (b r[k-1] - y[k-1]) + (Kd[k-1] - Kd[k]) D[k-1].
///
/// In manual mode u is `manual_command` within the limits or, with "holds", the last automatic command. I
/// follows, so that the first automatic command continues from the manual one: what the error adds in that
/// sample is the only change. Anti-windup, in automatic mode, is that of the PidController.
///
/// K. J. Åström, T. Hägglund, Advanced PID Control (2006), sections 3.5, 9.3 and 13.4.
#include "blocks/control/command_limits.h"
#include "blocks/logic/truth.h"
#include "models/signal/first_order.h"

namespace loopwright::blocks {

enum class ManualMode { follows, holds };
constexpr auto names_of(ManualMode) { return std::array<std::string_view, 2>{"follows", "holds"}; }

template <class Real> struct ScheduledPidController {
  Real derivative_pole, b = 1.0, c = 1.0, low = -infinity, high = infinity, tracking_gain = 0.0,
                        initial = 0.0, initial_measured = 0.0;
  AntiWindup anti_windup = AntiWindup::clamping;
  ManualMode in_manual = ManualMode::follows;
  TustinDerivative<Real> filter;
  Real half_sample, tracked;  // T/2; fraction of the excess removed from the integral per sample
  struct In {
    Real reference, measured, Kp, Ki, Kd, manual, manual_command;
  };
  struct Out {
    Real command;
  };
  struct Memory {
    Real integral, proportional, error, signal, slope, Kp, Kd, command, has_gains;
  };
  static constexpr auto describe() {
    using B = ScheduledPidController;
    return block(
        "A PID controller whose gains are signals, with manual mode, without bumps; sampled.",
        parameter(&B::derivative_pole, "derivative_pole", "rad/s", "Bandwidth of the derivative").positive(),
        parameter(&B::b, "b", "", "Weight of the reference in the proportional part").optional(),
        parameter(&B::c, "c", "", "Weight of the reference in the derivative part").optional(),
        parameter(&B::low, "low", "$command", "Least command").optional(),
        parameter(&B::high, "high", "$command", "Greatest command").optional(),
        parameter(&B::anti_windup, "anti_windup", "", "What the integral does at a limit").optional(),
        parameter(&B::tracking_gain, "tracking_gain", "1/s", "Speed of the back calculation")
            .not_negative()
            .optional(),
        parameter(&B::in_manual, "in_manual", "",
                  "Whether manual_command is followed, or the last command held")
            .optional(),
        parameter(&B::initial, "initial", "$command", "Integral part at the start").optional(),
        parameter(&B::initial_measured, "initial_measured", "$signal",
                  "Reference and measured signal before the start, at rest")
            .optional(),
        input(&In::reference, "reference", "$signal", "What is wanted"),
        input(&In::measured, "measured", "$signal", "What is"),
        input(&In::Kp, "Kp", "$command/$signal", "Proportional gain"),
        input(&In::Ki, "Ki", "$command/$signal/s", "Integral gain").otherwise(0),
        input(&In::Kd, "Kd", "$command*s/$signal", "Derivative gain").otherwise(0),
        input(&In::manual, "manual", "", "Logic value: manual mode while it is true").otherwise(0),
        input(&In::manual_command, "manual_command", "$command", "Command in manual mode").otherwise(0),
        output(&Out::command, "command", "$command", "What to do about it"));
  }
  void check(const Checker& checker) const { check_limits(checker, low, high, anti_windup, tracking_gain); }
  void prepare(double sample_time) {
    filter = TustinDerivative<Real>::of(derivative_pole, sample_time);
    half_sample = 0.5 * sample_time;
    tracked = 1.0 - exponential(-tracking_gain * sample_time);
  }
  void start(Memory& memory) const {
    memory.integral = initial;
    memory.proportional = (b - 1.0) * initial_measured;
    memory.signal = (c - 1.0) * initial_measured;
    memory.command = limited(initial);
  }
  Fault outputs(const In& in, const Memory& memory, Out& out) const {
    out.command = command(in, next(in, memory), memory);
    return fault_unless_logic(in.manual);
  }
  void update(const In& in, Memory& memory) const {
    Memory now = next(in, memory);
    const Real v = unlimited(in, now), excess = v - limited(v), before = carried_over(in, memory);
    if (anti_windup == AntiWindup::back_calculation) now.integral = now.integral - tracked * excess;
    const auto goes_further_out = excess * (now.integral - before) > 0.0;
    if (anti_windup == AntiWindup::clamping) now.integral = select(goes_further_out, before, now.integral);
    now.command = command(in, now, memory);
    const Real following = now.command - in.Kp * now.proportional - in.Kd * now.slope;
    now.integral = select(is_true(in.manual), following, now.integral);
    memory = now;
  }

 private:
  Real limited(const Real& v) const { return minimum(maximum(v, low), high); }
  /// The integral with which the new gains give the last command again.
  Real carried_over(const In& in, const Memory& memory) const {
    const Real changed = (memory.Kp - in.Kp) * memory.proportional + (memory.Kd - in.Kd) * memory.slope;
    return memory.integral + select(memory.has_gains > 0.5, changed, Real(0.0));
  }
  Memory next(const In& in, const Memory& memory) const {
    Memory now = memory;
    now.error = in.reference - in.measured;
    now.proportional = b * in.reference - in.measured;
    now.signal = c * in.reference - in.measured;
    now.slope = filter.next(now.signal, memory.signal, memory.slope);
    now.integral = carried_over(in, memory) + half_sample * in.Ki * (now.error + memory.error);
    now.Kp = in.Kp, now.Kd = in.Kd, now.has_gains = Real(1.0);
    return now;
  }
  Real unlimited(const In& in, const Memory& now) const {
    return in.Kp * now.proportional + now.integral + in.Kd * now.slope;
  }
  Real command(const In& in, const Memory& now, const Memory& last) const {
    const Real manual = in_manual == ManualMode::holds ? last.command : limited(in.manual_command);
    return select(is_true(in.manual), manual, limited(unlimited(in, now)));
  }
};
LOOPWRIGHT_BLOCK(ScheduledPidController)

}  // namespace loopwright::blocks
