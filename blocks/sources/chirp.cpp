/// y = bias + amplitude · sin(2π ∫ f dt + phase),  f = f₀ + (f₁ - f₀) t/T  or  f₀ (f₁/f₀)^(t/T)
///
/// The phase is the closed-form integral of the frequency, not a sum over steps. A logarithmic sweep takes
/// the same time for every octave. After its duration T the signal stays at the bias or starts again.
#include "blocks/sources/turns.h"

namespace loopwright::blocks {

enum class Sweep { linear, logarithmic };
constexpr auto names_of(Sweep) { return std::array<std::string_view, 2>{"linear", "logarithmic"}; }

template <class Real> struct Chirp {
  Real amplitude = 1.0, first_frequency, last_frequency, duration, start_time = 0.0, phase = 0.0, bias = 0.0;
  Sweep sweep = Sweep::linear;
  bool repeats = false;
  Real ratio;  // ln(f₁/f₀)
  Periods<Real> periods;
  struct Out {
    Real y, frequency;
  };
  struct Mode {
    Real begin, is_on;
  };  // begin: of this sweep, s
  static constexpr auto describe() {
    return block(
        "A sine wave whose frequency sweeps from one value to another.",
        parameter(&Chirp::amplitude, "amplitude", "$y", "Half of the distance from trough to crest")
            .difference()
            .optional(),
        parameter(&Chirp::first_frequency, "from", "Hz", "Frequency at the start").not_negative(),
        parameter(&Chirp::last_frequency, "to", "Hz", "Frequency at the end").not_negative(),
        parameter(&Chirp::duration, "duration", "s", "How long one sweep takes").positive(),
        parameter(&Chirp::sweep, "sweep", "", "How the frequency changes: as much per second, or per octave")
            .optional(),
        parameter(&Chirp::start_time, "start", "s", "When it begins").optional(),
        parameter(&Chirp::repeats, "repeats", "", "Whether it starts anew at its end").optional(),
        parameter(&Chirp::phase, "phase", "rad", "Phase at the start").optional(),
        parameter(&Chirp::bias, "bias", "$y", "Mean value").optional(),
        output(&Out::y, "y", "$y", "The sweep"),
        output(&Out::frequency, "frequency", "Hz", "Frequency at this moment; 0 at rest"));
  }
  void check(const Checker& checker) const {
    if (sweep == Sweep::linear || (first_frequency > 0.0 && last_frequency > 0.0)) return;
    checker.error(first_frequency > 0.0 ? "to" : "from", "a logarithmic sweep cannot reach 0 Hz").expected =
        "a number above 0 in Hz";
  }
  void prepare(double) {
    periods.start = start_time, periods.period = duration;
    Real* const all[] = {&periods.start, &periods.period};
    periods.units = to_counts<Real>(all);
    ratio =
        sweep == Sweep::linear ? Real(0.0) : Real(natural_logarithm(Real(last_frequency / first_frequency)));
  }
  void decide(const Instant& now, Mode& mode) const {
    const Real cycle = periods.at(Real(now.time));
    const auto is_on = repeats ? cycle >= 0.0 : cycle == 0.0;
    mode.begin = periods.time(repeats ? cycle : Real(0.0));
    mode.is_on = select(is_on, Real(1.0), Real(0.0));
  }
  void outputs(const Instant& now, const Mode& mode, Out& out) const {
    const Real t = now.time - mode.begin, share = t / duration;
    Real frequency, turns;
    if (sweep == Sweep::linear) {
      frequency = first_frequency + (last_frequency - first_frequency) * share;
      turns = 0.5 * (first_frequency + frequency) * t;
    } else {
      frequency = first_frequency * exponential(Real(ratio * share));
      turns = first_frequency * t * mean_growth(Real(ratio * share));
    }
    out.y = bias + select(mode.is_on > 0.5, amplitude * sine_of_turns(turns, phase), Real(0.0));
    out.frequency = select(mode.is_on > 0.5, frequency, Real(0.0));
  }
  double next_stop(double now) const {
    const double cycle = std::max(-1.0, lane(periods.at(Real(now)), 0));
    return repeats || cycle < 1.0 ? lane(periods.time(Real(cycle + 1.0)), 0) : infinity;
  }
  double shortest_period() const {
    const double fastest = std::max(lane(first_frequency, 0), lane(last_frequency, 0));
    return fastest > 0.0 && lane(amplitude, 0) != 0.0 ? 1.0 / fastest : infinity;
  }

 private:
  /// (eˣ - 1) / x, also near x = 0, where eˣ - 1 = 2 tanh(x/2) / (1 - tanh(x/2)) has no cancellation.
  static Real mean_growth(const Real& x) {
    const Real t = hyperbolic_tangent(Real(0.5 * x));
    const Real growth = select(absolute(x) < 1.0, 2.0 * t / (1.0 - t), exponential(x) - 1.0);
    return select(x == 0.0, Real(1.0), growth / x);
  }
};
LOOPWRIGHT_BLOCK(Chirp)

}  // namespace loopwright::blocks
