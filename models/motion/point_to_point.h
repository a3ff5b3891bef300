/// The fastest motion along a line, from any state to rest at a target, within limits on velocity,
/// acceleration and jerk.
///
/// The optimum switches between the limits (T. Kröger, On-Line Trajectory Generation in Robotic Systems,
/// 2010): let s point from where the axis would come to rest fastest towards the target. Jerk s·J raises the
/// acceleration, which may stay at its limit; then either the velocity reaches its limit and is held, or not;
/// from there the axis comes to rest as fast as possible, at the target. The time of raising the acceleration
/// is the only unknown. The distance grows with it, so that bisection finds it.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

namespace loopwright {

struct MotionState {
  double position = 0, velocity = 0, acceleration = 0;
};
/// All above 0. Without a limit on jerk (infinity) the velocity is a trapezoid.
struct MotionLimits {
  double velocity, acceleration, jerk;
};

class PointToPointMotion {
 public:
  static constexpr int phases = 7;
  struct Piece {
    double duration = 0, acceleration = 0, jerk = 0;  ///< acceleration at its begin
  };
  using Pieces = std::array<Piece, phases>;  ///< raise, hold, lower; cruise; lower, hold, raise

  /// At rest at a position, for all times.
  static PointToPointMotion at_rest(double position) {
    PointToPointMotion motion;
    motion.target_ = position;
    return motion;
  }
  /// `from` keeps the limits, now and when its acceleration is taken back to zero.
  static PointToPointMotion between(const MotionState& from, double target, const MotionLimits& limits);
  /// Seven given pieces, which end at `target` with a velocity and without acceleration after `duration`: the
  /// first three from the start, the last three backwards from the end, between them what time is left.
  static PointToPointMotion of_pieces(const MotionState& from, const Pieces& pieces, double target,
                                      double end_velocity, double duration);

  double target() const { return target_; }
  /// Time from the start to rest at the target.
  double duration() const { return phases_.back().end; }
  /// The phase at a time since the start; `phases` at rest at the target.
  int phase_at(double time) const {
    int phase = 0;
    while (phase < phases && !(time < phases_[size_t(phase)].end)) ++phase;
    return phase;
  }
  /// Infinity for `phases`.
  double end_of_phase(int phase) const { return phase < phases ? phases_[size_t(phase)].end : HUGE_VAL; }
  /// The state at a time, continued smoothly where the time is outside the phase.
  MotionState state_at(double time, int phase) const {
    return phase < phases ? phases_[size_t(phase)].at(time) : MotionState{target_, end_velocity_, 0};
  }
  MotionState state_at(double time) const { return state_at(time, phase_at(time)); }

 private:
  /// Constant jerk: a polynomial about its begin or its end.
  struct Phase {
    double end = 0;               // time since the start
    double origin = 0, jerk = 0;  // of the polynomial
    MotionState there;            // at the origin
    MotionState at(double time) const {
      const double t = time - origin;
      return {there.position + t * (there.velocity + t * (there.acceleration / 2 + t * (jerk / 6))),
              there.velocity + t * (there.acceleration + t * (jerk / 2)), there.acceleration + t * jerk};
    }
  };
  static MotionState after(const Piece& piece, const MotionState& begin) {
    MotionState from = begin;
    from.acceleration = piece.acceleration;
    return Phase{0, 0, piece.jerk, from}.at(piece.duration);
  }
  /// Distance from a state through consecutive pieces.
  static double distance(const Pieces& pieces, double velocity) {
    MotionState state{0, velocity, 0};
    for (const Piece& piece : pieces) state = after(piece, state);
    return state.position;
  }

  static void add_stop(double velocity, double acceleration, const MotionLimits& limits, Pieces& pieces);
  static double velocity_at_rest_of_acceleration(double velocity, double acceleration, double jerk) {
    return velocity + acceleration * std::fabs(acceleration) / (2 * jerk);
  }
  static double stopping_distance(double velocity, double acceleration, const MotionLimits& limits);
  static Pieces raised(double time, const MotionState& from, const MotionLimits& limits);
  static Pieces jerk_limited(const MotionState& from, double distance_left, const MotionLimits& limits);
  static Pieces trapezoid(double velocity, double distance_left, const MotionLimits& limits);
  void join(const MotionState& from, double sign, const Pieces& pieces);

  std::array<Phase, phases> phases_{};
  double target_ = 0, end_velocity_ = 0;
};

/// The fastest stop of a motion that goes forward when its acceleration has been taken back.
inline void PointToPointMotion::add_stop(double velocity, double acceleration, const MotionLimits& limits,
                                         Pieces& pieces) {
  const double jerk = limits.jerk;
  const double square = std::max(0.0, jerk * velocity + acceleration * acceleration / 2);
  const double peak = std::max(-acceleration, std::min(limits.acceleration, std::sqrt(square)));
  const double hold =
      peak < limits.acceleration
          ? 0.0
          : std::max(0.0, (velocity + acceleration * acceleration / (2 * jerk)) / peak - peak / jerk);
  pieces[4] = {(acceleration + peak) / jerk, acceleration, -jerk};
  pieces[5] = {hold, -peak, 0};
  pieces[6] = {peak / jerk, -peak, jerk};
}

inline double PointToPointMotion::stopping_distance(double velocity, double acceleration,
                                                    const MotionLimits& limits) {
  const double sign = velocity_at_rest_of_acceleration(velocity, acceleration, limits.jerk) < 0 ? -1 : 1;
  Pieces pieces{};
  add_stop(sign * velocity, sign * acceleration, limits, pieces);
  return sign * distance(pieces, sign * velocity);
}

/// The acceleration is raised, and held at its limit, for this time in all.
inline PointToPointMotion::Pieces PointToPointMotion::raised(double time, const MotionState& from,
                                                             const MotionLimits& limits) {
  const double rise = std::min(time, (limits.acceleration - from.acceleration) / limits.jerk);
  Pieces pieces{};
  pieces[0] = {rise, from.acceleration, limits.jerk};
  const double acceleration = rise < time
                                  ? limits.acceleration
                                  : std::min(limits.acceleration, from.acceleration + limits.jerk * rise);
  pieces[1] = {time - rise, acceleration, 0};
  return pieces;
}

/// For a target ahead of where the axis would come to rest. Position 0 is the start.
inline PointToPointMotion::Pieces PointToPointMotion::jerk_limited(const MotionState& from,
                                                                   double distance_left,
                                                                   const MotionLimits& limits) {
  const double jerk = limits.jerk, most = limits.acceleration;
  // The longest time for which the acceleration is raised and held: then the velocity just reaches its limit.
  const double square =
      std::max(0.0, jerk * (limits.velocity - from.velocity) + from.acceleration * from.acceleration / 2);
  const double peak = std::max(from.acceleration, std::min(most, std::sqrt(square)));
  const double hold = peak < most ? 0.0 : std::max(0.0, square / (jerk * most) - most / jerk);
  const double longest = (peak - from.acceleration) / jerk + hold;

  Pieces cruising = raised(longest, from, limits);
  const double reached = cruising[1].acceleration;
  cruising[2] = {std::max(0.0, reached / jerk), reached, -jerk};
  add_stop(limits.velocity, 0, limits, cruising);
  const double left = distance_left - distance(cruising, from.velocity);
  if (left >= 0) {
    cruising[3].duration = left / limits.velocity;
    return cruising;
  }
  const auto with_stop = [&](double time) {
    Pieces pieces = raised(time, from, limits);
    MotionState state{0, from.velocity, from.acceleration};
    for (int i = 0; i < 2; ++i) state = after(pieces[size_t(i)], state);
    add_stop(state.velocity, pieces[1].acceleration, limits, pieces);
    return pieces;
  };
  // While the axis still moves away from the target, it comes to rest where it would anyway: too early.
  const auto is_too_long = [&](double time) {
    const Pieces pieces = with_stop(time);
    MotionState state{0, from.velocity, 0};
    for (int i = 0; i < 2; ++i) state = after(pieces[size_t(i)], state);
    if (velocity_at_rest_of_acceleration(state.velocity, pieces[1].acceleration, jerk) < 0) return false;
    return distance(pieces, from.velocity) > distance_left;
  };
  double low = 0, high = longest;
  constexpr int most_halvings = 200;  // the interval is that of neighboring numbers after some 60
  for (int i = 0; i < most_halvings; ++i) {
    const double middle = low + (high - low) / 2;
    if (!(low < middle && middle < high)) break;
    (is_too_long(middle) ? high : low) = middle;
  }
  return with_stop(low);
}

inline PointToPointMotion::Pieces PointToPointMotion::trapezoid(double velocity, double distance_left,
                                                                const MotionLimits& limits) {
  const double most = limits.acceleration;
  const double square = std::max(0.0, most * distance_left + velocity * velocity / 2);
  const double peak = std::max(velocity, std::min(limits.velocity, std::sqrt(square)));
  const double left = distance_left - (2 * peak * peak - velocity * velocity) / (2 * most);
  Pieces pieces{};
  pieces[1] = {(peak - velocity) / most, most, 0};
  pieces[3] = {peak < limits.velocity ? 0.0 : std::max(0.0, left / peak), 0, 0};
  pieces[5] = {peak / most, -most, 0};
  return pieces;
}

/// The first three phases from the start, the others backwards from the target: it ends there exactly.
inline void PointToPointMotion::join(const MotionState& from, double sign, const Pieces& pieces) {
  MotionState state = from;
  double time = 0;
  for (size_t i = 0; i < phases; ++i) {
    Phase& phase = phases_[i];
    state.acceleration = sign * pieces[i].acceleration;
    phase.origin = time, phase.jerk = sign * pieces[i].jerk, phase.there = state;
    phase.end = time += pieces[i].duration;
    state = phase.at(time);
  }
  state = {target_, 0, 0};
  for (size_t i = phases; i-- > 3;) {
    Phase& phase = phases_[i];
    state.acceleration = sign * (pieces[i].acceleration + pieces[i].jerk * pieces[i].duration);
    if (i + 1 == phases && pieces[i].jerk != 0) state.acceleration = 0;
    phase.origin = phase.end, phase.there = state;
    state = phase.at(phase.end - pieces[i].duration);
  }
}

inline PointToPointMotion PointToPointMotion::of_pieces(const MotionState& from, const Pieces& pieces,
                                                        double target, double end_velocity, double duration) {
  PointToPointMotion motion;
  motion.target_ = target, motion.end_velocity_ = end_velocity;
  MotionState state = from;
  double time = 0;
  for (size_t i = 0; i < 3; ++i) {
    state.acceleration = pieces[i].acceleration;
    motion.phases_[i] = {time + pieces[i].duration, time, pieces[i].jerk, state};
    time = motion.phases_[i].end;
    state = motion.phases_[i].at(time);
  }
  state = {target, end_velocity, 0};
  double end = duration;
  for (size_t i = phases; i-- > 3;) {
    state.acceleration = pieces[i].acceleration + pieces[i].jerk * pieces[i].duration;
    if (i == 3 || (i + 1 == phases && pieces[i].jerk != 0)) state.acceleration = 0;
    motion.phases_[i] = {end, end, pieces[i].jerk, state};
    end = std::max(time, end - pieces[i].duration);
    state = motion.phases_[i].at(end);
  }
  return motion;
}

inline PointToPointMotion PointToPointMotion::between(const MotionState& from, double target,
                                                      const MotionLimits& limits) {
  PointToPointMotion motion;
  motion.target_ = target;
  const bool is_trapezoid = !std::isfinite(limits.jerk);
  const double distance = target - from.position;
  const double stop = is_trapezoid ? from.velocity * std::fabs(from.velocity) / (2 * limits.acceleration)
                                   : stopping_distance(from.velocity, from.acceleration, limits);
  const double sign = distance < stop ? -1 : 1;
  const MotionState ahead{0, sign * from.velocity, sign * from.acceleration};
  motion.join(from, sign,
              is_trapezoid ? trapezoid(ahead.velocity, sign * distance, limits)
                           : jerk_limited(ahead, sign * distance, limits));
  return motion;
}

}  // namespace loopwright
