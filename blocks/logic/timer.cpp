/// on_delay: y = 1 once u has been true for the duration, 0 as soon as it is false
/// off_delay: y = 1 as soon as u is true, 0 once it has been false for the duration
/// one_shot: y = 1 for the duration from a rising edge of u, whatever u does meanwhile
///
/// These are TON, TOF and TP of IEC 61131-3. With a sample time, y changes at the first sample at or after
/// the end of the duration. Without one, a variable-step solver finds the end exactly, and a fixed-step
/// method at its next step. A one-shot that runs cannot be started again.
#include "blocks/logic/truth.h"

namespace loopwright::blocks {

enum class TimerKind { on_delay, off_delay, one_shot };
constexpr auto names_of(TimerKind) {
  return std::array<std::string_view, 3>{"on_delay", "off_delay", "one_shot"};
}

template <class Real> struct Timer {
  TimerKind kind;
  Real duration;
  struct In {
    Real u;
  };
  struct Out {
    Real y, elapsed;
  };
  struct Mode {
    Real y, last, since, runs;  // since: the time, in s, at which the present duration began
  };
  struct Crossings {
    Real u, end;
  };
  static constexpr auto describe() {
    return block(
        "Delays a logic value, or makes a pulse of it.",
        parameter(&Timer::kind, "kind", "", "What is delayed, or that it is a pulse"),
        parameter(&Timer::duration, "duration", "s", "The delay, or the length of the pulse").not_negative(),
        input(&In::u, "u", "", "Logic value, true above 0.5"),
        output(&Out::y, "y", "", "The delayed logic value, or the pulse"),
        output(&Out::elapsed, "elapsed", "s", "How much of the duration has passed; 0 when idle"),
        crossing(&Crossings::u, "u"), crossing(&Crossings::end, "end"));
  }
  void start(Mode& mode) const { mode = {0.0, unknown_truth, 0.0, 0.0}; }
  Fault decide(const Instant& now, const In& in, Mode& mode) const {
    const auto on = is_true(in.u), was_running = mode.runs > 0.5;
    const auto starts = start_of_duration(on, mode.last) & !was_running;
    mode.since = select(starts, Real(now.time), mode.since);
    const auto has_ended = past_end(now, mode) >= 0.0;
    if (kind == TimerKind::on_delay) {
      mode.runs = as_number<Real>(on);
      mode.y = as_number<Real>(on & has_ended);
    } else {
      const auto may_run = kind == TimerKind::off_delay ? !on : MaskOf<Real>(true);
      mode.runs = as_number<Real>((starts | was_running) & may_run & !has_ended);
      mode.y = kind == TimerKind::off_delay ? select(on, Real(1.0), mode.runs) : mode.runs;
    }
    mode.last = as_number<Real>(on);
    return fault_unless_logic(in.u);
  }
  void outputs(const Instant& now, const Mode& mode, Out& out) const {
    out.y = mode.y;
    out.elapsed = select(mode.runs > 0.5, minimum(Real(now.time - mode.since), duration), Real(0.0));
  }
  void crossings(const Instant& now, const In& in, const Mode& mode, Crossings& value) const {
    value.u = truth_crossing(in.u);
    value.end = select(mode.runs > 0.5, not_below_zero(past_end(now, mode)), Real(-1.0));
  }

 private:
  /// An on-delay also begins with a signal that is true at the start.
  MaskOf<Real> start_of_duration(const MaskOf<Real>& on, const Real& last) const {
    if (kind == TimerKind::on_delay) return on;
    return is_edge<Real>(kind == TimerKind::off_delay ? EdgeKind::falling : EdgeKind::rising, last, on);
  }
  /// How long ago the duration ended. 0.1 s + 0.2 s and 0.3 s differ by rounding: an end that is missed by no
  /// more than that is met.
  Real past_end(const Instant& now, const Mode& mode) const {
    constexpr double rounding = 0x1p-50;  // four units in the last place of the time
    return (now.time - mode.since) - duration + rounding * std::fabs(now.time);
  }
};
LOOPWRIGHT_BLOCK(Timer)

}  // namespace loopwright::blocks
