/// v = Kp (b r - y) + I + Kd ω s/(s+ω) (c r - y),  I' = Ki (r - y) with anti-windup,  u = v within [low,
/// high]
///
/// Anti-windup, while v is outside the limits: "back_calculation" gives I' = Ki (r - y) + tracking_gain (u -
/// v); "clamping" stops I where the error would drive v further out, fading over a hundredth of the greatest
/// limit. The derivative starts at rest, as if its signal had not changed before. Parallel form with setpoint
/// weights b and c after K. J. Åström, T. Hägglund, Advanced PID Control (2006), sections 3.3 to 3.5.
#include "blocks/control/command_limits.h"

namespace loopwright::blocks {

template <class Real> struct ContinuousPidController {
  Real Kp, Ki, Kd, derivative_pole, b = 1.0, c = 1.0, low = -infinity, high = infinity, tracking_gain = 0.0,
                                    initial = 0.0;
  AntiWindup anti_windup = AntiWindup::clamping;
  CommandLimits<Real> limits;
  struct In {
    Real reference, measured;
  };
  struct Out {
    Real command;
  };
  struct State {
    Real integral, slow_signal;
  };
  struct Mode {
    Real has_begun, begin;  // begin: time of the first instant, s
  };
  struct Crossings {
    Real low, high;
  };
  static constexpr auto describe() {
    using B = ContinuousPidController;
    return block(
        "Proportional, integral and derivative feedback with limits, in continuous time.",
        parameter(&B::Kp, "Kp", "$command/$signal", "Proportional gain"),
        parameter(&B::Ki, "Ki", "$command/$signal/s", "Integral gain"),
        parameter(&B::Kd, "Kd", "$command*s/$signal", "Derivative gain"),
        parameter(&B::derivative_pole, "derivative_pole", "rad/s", "Bandwidth of the derivative").positive(),
        parameter(&B::b, "b", "", "Weight of the reference in the proportional part").optional(),
        parameter(&B::c, "c", "", "Weight of the reference in the derivative part").optional(),
        parameter(&B::low, "low", "$command", "Least command").optional(),
        parameter(&B::high, "high", "$command", "Greatest command").optional(),
        parameter(&B::anti_windup, "anti_windup", "", "What the integral does at a limit").optional(),
        parameter(&B::tracking_gain, "tracking_gain", "1/s", "Speed of the back calculation")
            .not_negative()
            .optional(),
        parameter(&B::initial, "initial", "$command", "Integral part at the start").optional(),
        input(&In::reference, "reference", "$signal", "What is wanted"),
        input(&In::measured, "measured", "$signal", "What is"),
        output(&Out::command, "command", "$command", "What to do about it"), crossing(&Crossings::low, "low"),
        crossing(&Crossings::high, "high"));
  }
  void check(const Checker& checker) const { check_limits(checker, low, high, anti_windup, tracking_gain); }
  void prepare(double) { limits = CommandLimits<Real>::of(low, high, anti_windup, tracking_gain); }
  void start(State& state) const { state.integral = initial; }
  void decide(const Instant& now, Mode& mode) const {
    mode.begin = select(mode.has_begun > 0.5, mode.begin, Real(now.time));
    mode.has_begun = Real(1.0);
  }
  void jump(const Instant& now, const In& in, const Mode& mode, State& state) const {
    state.slow_signal = select(mode.begin == now.time, signal(in), state.slow_signal);
  }
  void outputs(const In& in, const State& state, Out& out) const {
    out.command = limits.limited(unlimited(in, state));
  }
  void derivatives(const In& in, const State& state, State& rate) const {
    rate.integral = limits.integral_rate(unlimited(in, state), drive(in));
    rate.slow_signal = derivative_pole * (signal(in) - state.slow_signal);
  }
  void crossings(const In& in, const State& state, Crossings& value) const {
    const Real v = unlimited(in, state);
    value.low = limits.above_low(v);
    value.high = limits.above_high(v);
  }

 private:
  Real drive(const In& in) const { return Ki * (in.reference - in.measured); }
  Real signal(const In& in) const { return c * in.reference - in.measured; }
  Real unlimited(const In& in, const State& state) const {
    const Real slope = derivative_pole * (signal(in) - state.slow_signal);
    return Kp * (b * in.reference - in.measured) + state.integral + Kd * slope;
  }
};
LOOPWRIGHT_BLOCK(ContinuousPidController)

}  // namespace loopwright::blocks
