/// A half bridge between +bus/2 and -bus/2, with the mean voltage `command`
///
/// "switched": the upper switch is on while 2 command/bus is above a symmetric triangular carrier, which is
/// -1 at the whole periods and 1 half a period later; else the lower one. After each change both are off for
/// the dead time, and the current flows through a diode: the output is -bus/2 for a current out of the bridge
/// (positive), +bus/2 for one into it, and switches at once without a current. A command that is held from
/// sample to sample is sampled regularly. All switching instants are events for a variable-step solver; a
/// fixed step must be short beside the dead time.
///
/// "averaged": the mean over a period, u = command within ±bus/2, minus the error of the dead time,
/// bus · dead_time · frequency · tanh(current / current_width). The width stands for the ripple of the
/// current, within which its sign changes in each period.
///
/// N. Mohan, T. M. Undeland, W. P. Robbins, Power Electronics (2003), sections 8-3 and 8-5.
#include <algorithm>
#include "blocks/math/sides.h"
#include "models/real/exact_times.h"

namespace loopwright::blocks {

enum class PwmKind { switched, averaged };
constexpr auto names_of(PwmKind) { return std::array<std::string_view, 2>{"switched", "averaged"}; }

struct Pwm {
  double bus, frequency, dead_time = 0, current_width = 0;
  PwmKind kind = PwmKind::switched;
  Periods<double> halves;  // of the carrier: rising, falling …
  struct In {
    double command, current;
  };
  struct Out {
    double voltage;
  };
  struct Mode {
    double side, since, is_blank, outwards,
        has_begun;  // since: s, of the last change; outwards: sign of the current
  };
  struct Crossings {
    double carrier, blank, outwards, inwards;
  };
  static constexpr auto describe() {
    return block(
        "A half bridge with pulse-width modulation and dead time, switched or averaged.",
        parameter(&Pwm::bus, "bus", "V", "Voltage between the rails").positive(),
        parameter(&Pwm::frequency, "frequency", "Hz", "Periods of the carrier in a second").positive(),
        parameter(&Pwm::dead_time, "dead_time", "s", "Both switches are off after a change")
            .not_negative()
            .optional(),
        parameter(&Pwm::kind, "kind", "", "Every pulse, or their mean").optional(),
        parameter(&Pwm::current_width, "current_width", "A", "Averaged: ripple of the current")
            .not_negative()
            .optional(),
        input(&In::command, "command", "V", "Wanted mean of the voltage"),
        input(&In::current, "current", "A", "Current out of the bridge").otherwise(0),
        output(&Out::voltage, "voltage", "V", "Voltage of the output against the middle of the rails"),
        crossing(&Crossings::carrier, "carrier"), crossing(&Crossings::blank, "end of the dead time"),
        crossing(&Crossings::outwards, "outwards"), crossing(&Crossings::inwards, "inwards"));
  }
  void check(const Checker& checker) const {
    if (dead_time * frequency >= 0.5)
      checker.error("dead_time", "the dead time is half a period or more").expected =
          "less than 1/(2 frequency)";
    if (kind == PwmKind::averaged && dead_time > 0 && !(current_width > 0))
      checker.error("current_width", "the sign of the current changes within its ripple").expected =
          "a current above 0, such as half of the ripple from peak to peak";
  }
  void prepare(double) {
    halves.start = 0, halves.period = 0.5 / frequency;
    double* const all[] = {&halves.start, &halves.period};
    halves.units = to_counts<double>(all);
  }
  Fault decide(const Instant& now, const In& in, Mode& mode) const {
    if (kind == PwmKind::averaged) return {};
    const double side = above_zero(excess(now.time, in)) > 0 ? 1 : -1;
    if (mode.has_begun > 0.5 && side != mode.side) mode.since = now.time, mode.is_blank = 1;
    if (mode.is_blank > 0.5 && !(above_zero(mode.since + dead_time - now.time) > 0)) mode.is_blank = 0;
    mode.side = side, mode.has_begun = 1;
    mode.outwards = above_zero(in.current) > 0 ? 1 : above_zero(-in.current) > 0 ? -1 : 0;
    return fault_if_nan(in.command, in.current);
  }
  void outputs(const In& in, const Mode& mode, Out& out) const {
    if (kind == PwmKind::averaged) {
      const double error =
          dead_time > 0 ? bus * dead_time * frequency * hyperbolic_tangent(in.current / current_width) : 0;
      out.voltage = std::clamp(in.command, -0.5 * bus, 0.5 * bus) - error;
      return;
    }
    const bool by_diode = mode.is_blank > 0.5 && mode.outwards != 0;
    out.voltage = 0.5 * bus * (by_diode ? -mode.outwards : mode.side);
  }
  bool may_cross() const { return kind == PwmKind::switched; }
  void crossings(const Instant& now, const In& in, const Mode& mode, Crossings& value) const {
    value.carrier = above_zero(excess(now.time, in));
    value.blank = mode.is_blank > 0.5 ? above_zero(mode.since + dead_time - now.time) : -1;
    value.outwards = above_zero(in.current), value.inwards = above_zero(-in.current);
  }
  double next_stop(double now) const {
    return kind == PwmKind::averaged ? infinity : halves.time(halves.at(now) + 1);
  }
  double shortest_period() const { return kind == PwmKind::averaged ? infinity : 1 / frequency; }

 private:
  /// Of the command over the carrier, in half a bus voltage.
  double excess(double time, const In& in) const {
    const double half = halves.at(time), part = (time - halves.time(half)) * 2 * frequency;
    const bool rises = std::fmod(half, 2) == 0;
    return 2 * in.command / bus - (rises ? 2 * part - 1 : 1 - 2 * part);
  }
};
LOOPWRIGHT_BLOCK(Pwm)

}  // namespace loopwright::blocks
