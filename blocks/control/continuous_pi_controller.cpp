/// v = Kp (b r - y) + I,  I' = Ki (r - y) with anti-windup,  u = v within [low, high]
///
/// Anti-windup, while v is outside the limits: "back_calculation" gives I' = Ki (r - y) + tracking_gain (u -
/// v); "clamping" stops I where the error would drive v further out, fading over a hundredth of the greatest
/// limit. After K. J. Åström, T. Hägglund, Advanced PID Control (2006), section 3.5.
#include "blocks/control/command_limits.h"

namespace loopwright::blocks {

template <class Real> struct ContinuousPiController {
  Real Kp, Ki, b = 1.0, low = -infinity, high = infinity, tracking_gain = 0.0, initial = 0.0;
  AntiWindup anti_windup = AntiWindup::clamping;
  CommandLimits<Real> limits;
  struct In {
    Real reference, measured;
  };
  struct Out {
    Real command;
  };
  struct State {
    Real integral;
  };
  struct Crossings {
    Real low, high;
  };
  static constexpr auto describe() {
    using B = ContinuousPiController;
    return block(
        "Proportional and integral feedback with limits, in continuous time.",
        parameter(&B::Kp, "Kp", "$command/$signal", "Proportional gain"),
        parameter(&B::Ki, "Ki", "$command/$signal/s", "Integral gain"),
        parameter(&B::b, "b", "", "Weight of the reference in the proportional part").optional(),
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
  void outputs(const In& in, const State& state, Out& out) const {
    out.command = limits.limited(unlimited(in, state));
  }
  void derivatives(const In& in, const State& state, State& rate) const {
    rate.integral = limits.integral_rate(unlimited(in, state), drive(in));
  }
  void crossings(const In& in, const State& state, Crossings& value) const {
    const Real v = unlimited(in, state);
    value.low = limits.above_low(v);
    value.high = limits.above_high(v);
  }

 private:
  Real drive(const In& in) const { return Ki * (in.reference - in.measured); }
  Real unlimited(const In& in, const State& state) const {
    return Kp * (b * in.reference - in.measured) + state.integral;
  }
};
LOOPWRIGHT_BLOCK(ContinuousPiController)

}  // namespace loopwright::blocks
