/// Velocity through given values, joined by ramps. Position and acceleration are its closed-form integral and
/// derivative.
///
/// With s = t/T running from 0 to 1 over a segment, the velocity is v₀ + (v₁ - v₀) w(s):
///   raised_cosine  w = (1 - cos πs)/2       continuous acceleration
///   cubic          w = 3s² - 2s³            continuous acceleration, 5 % less peak
///   linear         w = s                    least peak acceleration, jumps at the borders
/// A pass ends at the velocity of its last segment. With `returns` the same path is run back in mirrored
/// time. There are `passes` consecutive passes; after them the last velocity is held.
#include "blocks/sources/turns.h"
#include "models/real/whole.h"

namespace loopwright::blocks {

enum class RampShape { raised_cosine, cubic, linear };
constexpr auto names_of(RampShape) {
  return std::array<std::string_view, 3>{"raised_cosine", "cubic", "linear"};
}

template <class Real> struct MotionProfile {
  struct Segment {
    Real duration, velocity;
    static constexpr auto describe() {
      return fields(parameter(&Segment::duration, "duration", "s", "How long the segment lasts").positive(),
                    parameter(&Segment::velocity, "velocity", "$position/s", "Velocity at its end"));
    }
  };
  struct Piece {
    Real begin, position, velocity, change, duration;
  };  // begin, in units, and position are relative to the start of a pass
  std::vector<Segment> segments;
  RampShape shape = RampShape::raised_cosine;
  Real start_position = 0.0, start_velocity = 0.0, start_time = 0.0;
  bool returns = false;
  int passes = 1;
  std::vector<Piece> pieces;
  Real distance;          // of a pass
  Periods<Real> periods;  // the passes
  struct Out {
    Real position, velocity, acceleration;
  };
  struct Mode {
    Real pass, piece, from, until;
  };  // piece -1: not started; it lasts in [from, until), s
  static constexpr auto describe() {
    return block(
        "A smooth motion through given velocities.",
        parameter(&MotionProfile::segments, "segments", "",
                  "Durations and the velocities at their ends; equal velocities hold"),
        parameter(&MotionProfile::shape, "shape", "", "How velocity changes inside a segment").optional(),
        parameter(&MotionProfile::start_position, "start_position", "$position", "Position at the start")
            .optional(),
        parameter(&MotionProfile::start_velocity, "start_velocity", "$position/s", "Velocity at the start")
            .optional(),
        parameter(&MotionProfile::start_time, "start", "s", "When it begins").optional(),
        parameter(&MotionProfile::returns, "returns", "", "Whether each pass runs back to where it began")
            .optional(),
        parameter(&MotionProfile::passes, "passes", "", "How many passes; 0: without end")
            .not_negative()
            .optional(),
        output(&Out::position, "position", "$position", "Wanted position"),
        output(&Out::velocity, "velocity", "$position/s", "Wanted velocity"),
        output(&Out::acceleration, "acceleration", "$position/s^2", "Wanted acceleration"));
  }
  void check(const Checker& checker) const;
  void prepare(double);
  void decide(const Instant& now, Mode& mode) const {
    const Real time = now.time;
    if (!any((time < mode.from) | (time >= mode.until))) return;
    const Real pass = maximum(periods.at(time), Real(0.0)), last = passes > 0 ? passes - 1.0 : infinity;
    mode.pass = minimum(pass, last);
    mode.piece = Real(-1.0), mode.from = Real(-infinity);
    mode.until = select(mode.pass < last, periods.time(mode.pass + 1.0), Real(infinity));
    for (size_t i = 0; i < pieces.size(); ++i) {
      const Real begin = periods.time(mode.pass, pieces[i].begin);
      const auto has_begun = begin <= time;
      mode.piece = select(has_begun, Real(double(i)), mode.piece);
      mode.from = select(has_begun, begin, mode.from);
      mode.until = select(has_begun, mode.until, minimum(mode.until, begin));
    }
  }
  void outputs(const Instant& now, const Mode& mode, Out& out) const {
    const Piece p = piece_at(mode.piece);
    const auto waits = mode.piece < 0.0;
    const Real t = select(waits, Real(0.0), now.time - mode.from), s = t / p.duration;
    Real share, integral, slope;  // w, ∫w ds, dw/ds
    if (shape == RampShape::raised_cosine) {
      const auto wave = sine_cosine(Real(pi * s));
      share = 0.5 * (1.0 - wave.cosine), integral = 0.5 * (s - wave.sine * (1.0 / pi)),
      slope = 0.5 * pi * wave.sine;
    } else if (shape == RampShape::cubic) {
      share = s * s * (3.0 - 2.0 * s), integral = s * s * s * (1.0 - 0.5 * s), slope = 6.0 * s * (1.0 - s);
    } else {
      share = s, integral = 0.5 * s * s, slope = 1.0;
    }
    const Real passed = select(waits, Real(0.0), mode.pass * distance);
    out.position = start_position + passed + p.position + p.velocity * t + p.change * p.duration * integral;
    out.velocity = select(waits, Real(0.0), p.velocity + p.change * share);
    out.acceleration = select(waits, Real(0.0), p.change * slope / p.duration);
  }
  double next_stop(double now) const;

 private:
  Piece piece_at(const Real& index) const {
    const double first = lane(index, 0);
    if (!any(index != first)) return pieces[whole_index(first, pieces.size())];
    Piece here;
    for (int l = 0; l < lanes_of<Real>; ++l) {
      const Piece& p = pieces[whole_index(lane(index, l), pieces.size())];
      for (Real Piece::*m :
           {&Piece::begin, &Piece::position, &Piece::velocity, &Piece::change, &Piece::duration})
        set_lane(here.*m, l, lane(p.*m, l));
    }
    return here;
  }
};

template <class Real> void MotionProfile<Real>::check(const Checker& checker) const {
  if (segments.empty()) {
    checker.error("segments", "a motion needs at least one segment").expected =
        "[{\"duration\": …, \"velocity\": …}, …]";
    return;
  }
  const auto jump = [&](const char* parameter, const char* message, const std::string& expected) {
    auto& p = checker.error(parameter, message);
    p.expected = expected;
    p.found = reading::number_text(segments.back().velocity);
  };
  if (returns && segments.back().velocity != 0.0)
    jump("segments", "velocity would jump where the motion turns back", "0 as the last velocity");
  if (passes != 1 && !returns && segments.back().velocity != start_velocity)
    jump("segments", "velocity would jump where a pass follows the other",
         "the last velocity equal to start_velocity");
  if (returns && start_velocity != 0.0 && passes != 1)
    checker.error("start_velocity", "velocity would jump where a pass follows the other").expected =
        "0 with \"returns\"";
}

template <class Real> void MotionProfile<Real>::prepare(double) {
  pieces.clear();
  std::vector<Real> lengths;  // of the segments, in units
  for (const Segment& s : segments) lengths.push_back(s.duration);
  periods.start = start_time;
  std::vector<Real*> all{&periods.start};
  for (Real& length : lengths) all.push_back(&length);
  periods.units = to_counts<Real>(all);
  Real time = 0.0, position = 0.0, velocity = start_velocity;
  for (size_t i = 0; i < segments.size(); ++i) {
    const Segment& s = segments[i];
    pieces.push_back({time, position, velocity, s.velocity - velocity, s.duration});
    position = position + 0.5 * (velocity + s.velocity) * s.duration;
    time = time + lengths[i], velocity = s.velocity;
  }
  distance = returns ? Real(0.0) : position;
  if (returns)
    for (size_t i = segments.size(); i-- > 0;) {
      const Piece there = pieces[i];  // a copy: the list grows in this loop
      const Real end = i + 1 < segments.size() ? pieces[i + 1].position : position;
      pieces.push_back({time, end, -(there.velocity + there.change), there.change, there.duration});
      time = time + lengths[i];
    }
  periods.period = time;
  const Real last = returns ? Real(-start_velocity) : velocity;
  pieces.push_back({time, distance, last, Real(0.0), Real(1.0)});
}

template <class Real> double MotionProfile<Real>::next_stop(double now) const {
  double pass = lane(periods.at(Real(now)), 0);
  if (pass < 0.0) return lane(periods.time(Real(0.0)), 0);
  if (passes > 0) pass = std::min(pass, passes - 1.0);
  for (const Piece& p : pieces) {
    const double begin = lane(periods.time(Real(pass), p.begin), 0);
    if (begin > now) return begin;
  }
  return passes > 0 && pass >= passes - 1.0 ? infinity : lane(periods.time(Real(pass + 1.0)), 0);
}
LOOPWRIGHT_BLOCK(MotionProfile)

}  // namespace loopwright::blocks
