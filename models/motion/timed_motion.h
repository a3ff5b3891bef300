/// Motions along a line that end at a given time, with a given velocity and without acceleration, within
/// limits on velocity, acceleration and jerk; so that several axes arrive together.
///
/// The axis changes its velocity as fast as possible to a cruising velocity c, keeps it, and changes it as
/// fast as possible to the one at the end. With the times t₁(c) and t₂(c) and the distances of both changes
/// it is at time T at P(c, T) = d₁(c) + (T - t₁(c) - t₂(c)) c + d₂(c). While both changes fit into T, a
/// greater c makes the velocity greater at every instant. P therefore grows with c, and bisection finds the c
/// that leads to the target. The changes fit in one or two intervals of c, because t₁ + t₂ rises outside of
/// the two velocities at which it has its corners, and is concave between them.
///
/// Not every time above the shortest one is possible: an axis that brakes for its target cannot come a little
/// later; it would overshoot and return. Where such a gap begins or ends, either c is at its limit, or no
/// time is left for cruising.
#pragma once
#include <boost/container/static_vector.hpp>
#include <optional>
#include <span>
#include "models/motion/point_to_point.h"

namespace loopwright {

/// Axes that arrive together. Lists have a greatest length, because motions are found within a step, which
/// allocates nothing.
constexpr size_t most_axes_together = 8;

/// The fastest change of velocity, to a state without acceleration: jerk, constant acceleration, jerk.
struct VelocityChange {
  std::array<PointToPointMotion::Piece, 3> pieces;
  double duration = 0, distance = 0;

  static VelocityChange between(double velocity, double acceleration, double end, const MotionLimits& limits);
};

class TimedMotion {
 public:
  /// `from` keeps the limits, now and when its acceleration is taken back to zero, as does `end_velocity`.
  TimedMotion(const MotionState& from, double target, double end_velocity, const MotionLimits& limits);

  /// The shortest time; infinity if numbers of this size have none.
  double fastest() const { return bounds_.empty() ? HUGE_VAL : bounds_.front().time; }
  /// The cruising velocity of a motion that takes this time; nothing if there is none.
  std::optional<double> cruise_for(double time) const;
  /// `cruise`: the one for that time; not a number: the fastest motion to rest, which need not cruise.
  PointToPointMotion motion(double time, double cruise) const;

  /// A time at which possible times may begin or end, and its cruising velocity.
  struct Bound {
    double time, cruise;
  };
  static constexpr size_t most_corners = 10;
  static constexpr int parts = 6;  // of the smooth intervals between corners, in which the distance may turn
  /// One at each limit, at each corner, in each part of the intervals between corners, and of the fastest
  /// motion.
  static constexpr size_t most_bounds = 2 + most_corners + parts * (most_corners - 1) + 1;
  using Bounds = boost::container::static_vector<Bound, most_bounds>;
  /// In rising order.
  const Bounds& bounds() const { return bounds_; }

 private:
  struct Changes {
    VelocityChange first, last;
    double time() const { return first.duration + last.duration; }
    double distance() const { return first.distance + last.distance; }
  };
  Changes changes(double cruise) const;
  double changing_time(double cruise) const { return changes(cruise).time(); }
  double position_at(double time, double cruise) const;
  using Corners = boost::container::static_vector<double, most_corners>;
  Corners corners() const;
  void find_bounds();
  std::optional<double> cruise_between(double low, double high, double time) const;
  double outermost(double inner, double outer, double time) const;

  MotionState from_;
  double target_, distance_, end_velocity_, tolerance_;
  MotionLimits limits_;
  Bounds bounds_;
};

/// The motions of all axes in the shortest common time.
struct CommonMotion {
  double duration = 0;
  boost::container::static_vector<double, most_axes_together> cruises;
};
/// At most `most_axes_together`.
CommonMotion common_motion(std::span<const TimedMotion> axes);

namespace timed_motion {

constexpr int most_halvings = 200;  // the interval is that of neighboring numbers after some 60 at most

/// The root of a function between two numbers at which its signs differ, to the last bit: by the Illinois
/// rule, with an interval halved now and then, because the functions here have corners. At the end that is
/// nearest.
template <class Function> double root(double low, double high, const Function& function) {
  double at_low = function(low), at_high = function(high);
  if (at_low == 0) return low;
  constexpr int halved_every = 3;
  for (int i = 1; i < most_halvings; ++i) {
    const double half = low + (high - low) / 2;
    double next = i % halved_every == 0 ? half : low + (high - low) * (at_low / (at_low - at_high));
    if (!(std::min(low, high) < next && next < std::max(low, high))) next = half;
    if (next == low || next == high) break;
    const double value = function(next);
    if (value == 0) return next;
    if ((value < 0) == (at_low < 0))
      low = next, at_low = value, at_high /= 2;
    else
      high = next, at_high = value, at_low /= 2;
  }
  return low;
}

}  // namespace timed_motion

inline VelocityChange VelocityChange::between(double velocity, double acceleration, double end,
                                              const MotionLimits& limits) {
  VelocityChange change;
  const double jerk = limits.jerk, most = limits.acceleration;
  const bool is_trapezoid = !std::isfinite(jerk);
  const double by_itself =
      is_trapezoid ? velocity : velocity + acceleration * std::fabs(acceleration) / (2 * jerk);
  const double sign = end < by_itself ? -1 : 1;
  if (is_trapezoid) {
    change.pieces[1] = {std::fabs(end - velocity) / most, sign * most, 0};
  } else {
    const double begin = sign * acceleration, gain = sign * (end - velocity);
    const double square = std::max(0.0, jerk * gain + begin * begin / 2);
    const double peak = std::max({begin, 0.0, std::min(most, std::sqrt(square))});
    const double hold = peak < most ? 0.0 : std::max(0.0, square / (jerk * most) - most / jerk);
    change.pieces = {{{(peak - begin) / jerk, acceleration, sign * jerk},
                      {hold, sign * peak, 0},
                      {peak / jerk, sign * peak, -sign * jerk}}};
  }
  double v = velocity;
  for (const auto& [time, a, j] : change.pieces) {
    change.distance += time * (v + time * (a / 2 + time * j / 6));
    v += time * (a + time * j / 2);
    change.duration += time;
  }
  return change;
}

inline TimedMotion::TimedMotion(const MotionState& from, double target, double end_velocity,
                                const MotionLimits& limits)
    : from_(from),
      target_(target),
      distance_(target - from.position),
      end_velocity_(end_velocity),
      limits_(limits) {
  const double stop =
      limits.velocity * (limits.velocity / limits.acceleration +
                         (std::isfinite(limits.jerk) ? limits.acceleration / limits.jerk : 0));
  constexpr double rounding = 1e-13;  // of distances that are sums of some ten terms
  tolerance_ = rounding * (std::fabs(from.position) + std::fabs(target) + std::fabs(distance_) + stop);
  find_bounds();
}

/// The last change is the mirror image in time of one that begins with the velocity at the end.
inline TimedMotion::Changes TimedMotion::changes(double cruise) const {
  return {VelocityChange::between(from_.velocity, from_.acceleration, cruise, limits_),
          VelocityChange::between(end_velocity_, 0, cruise, limits_)};
}

inline double TimedMotion::position_at(double time, double cruise) const {
  const Changes both = changes(cruise);
  return both.distance() + (time - both.time()) * cruise;
}

/// Cruising velocities at which t₁ + t₂ or its derivatives have corners, rising, with both limits.
inline TimedMotion::Corners TimedMotion::corners() const {
  const double most = limits_.velocity, a = from_.acceleration, jerk = limits_.jerk;
  Corners result{-most, most, 0, end_velocity_, from_.velocity};
  if (std::isfinite(jerk)) {
    const double square = limits_.acceleration * limits_.acceleration;
    result.push_back(from_.velocity + a * std::fabs(a) / (2 * jerk));
    for (const double sign : {-1.0, 1.0}) {
      result.push_back(from_.velocity + sign * (square - a * a / 2) / jerk);
      result.push_back(end_velocity_ + sign * square / jerk);
    }
  }
  for (double& corner : result) corner = std::clamp(corner, -most, most);
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

/// Where possible times begin or end: c at a limit, or no time for cruising, d₁(c) + d₂(c) = distance.
inline void TimedMotion::find_bounds() {
  const auto left = [&](double cruise) { return distance_ - changes(cruise).distance(); };
  for (const double limit : {-limits_.velocity, limits_.velocity}) {
    const Changes both = changes(limit);
    const double cruising = (distance_ - both.distance()) / limit;
    if (cruising >= 0) bounds_.push_back({both.time() + cruising, limit});
  }
  const Corners ends = corners();
  // What the last bit of c leaves of the distance is cruised.
  const auto add = [&](double cruise) {
    const double rest = cruise == 0 ? 0 : left(cruise) / cruise;
    bounds_.push_back({changing_time(cruise) + std::max(0.0, rest), cruise});
  };
  for (const double end : ends)
    if (std::fabs(left(end)) <= tolerance_) add(end);
  for (size_t k = 0; k + 1 < ends.size(); ++k)
    for (int i = 0; i < parts; ++i) {
      const double width = ends[k + 1] - ends[k];
      const double low = ends[k] + width * i / parts,
                   high = i + 1 == parts ? ends[k + 1] : ends[k] + width * (i + 1) / parts;
      const double at_low = left(low);
      if ((at_low < 0) == (left(high) < 0)) continue;
      const double root = timed_motion::root(low, high, left), next = std::nextafter(root, high);
      add(left(root) / root >= 0 ? root : left(next) / next >= 0 ? next : std::nextafter(root, low));
    }
  // An axis that brakes at the start may be fastest without an instant at which its acceleration is zero.
  if (end_velocity_ == 0)
    bounds_.push_back({PointToPointMotion::between(from_, target_, limits_).duration(), NAN});
  bounds_.erase(std::remove_if(bounds_.begin(), bounds_.end(),
                               [](const Bound& bound) { return !std::isfinite(bound.time); }),
                bounds_.end());
  std::sort(bounds_.begin(), bounds_.end(), [](const Bound& a, const Bound& b) { return a.time < b.time; });
}

/// The cruising velocity nearest to `outer` at which both changes fit into the time; they do at `inner`.
inline double TimedMotion::outermost(double inner, double outer, double time) const {
  if (changing_time(outer) <= time) return outer;
  const double found = timed_motion::root(inner, outer, [&](double c) { return changing_time(c) - time; });
  return changing_time(found) <= time ? found : std::nextafter(found, inner);
}

/// Both changes fit into the time everywhere between `low` and `high`.
inline std::optional<double> TimedMotion::cruise_between(double low, double high, double time) const {
  if (position_at(time, low) > distance_ + tolerance_ || position_at(time, high) < distance_ - tolerance_)
    return {};
  if (position_at(time, 0) == distance_ && low <= 0 && 0 <= high) return 0;
  if (position_at(time, low) >= distance_) return low;
  if (position_at(time, high) <= distance_) return high;
  return timed_motion::root(low, high, [&](double c) { return position_at(time, c) - distance_; });
}

inline std::optional<double> TimedMotion::cruise_for(double time) const {
  const double most = limits_.velocity, a = from_.acceleration;
  const double by_itself =
      std::clamp(from_.velocity + (std::isfinite(limits_.jerk) ? a * std::fabs(a) / (2 * limits_.jerk) : 0),
                 -most, most);
  const double low = std::min(by_itself, end_velocity_), high = std::max(by_itself, end_velocity_);
  // t₁ + t₂ is concave between its corners: its greatest value by halving the interval at its slope.
  constexpr int halvings_of_top = 26;  // down to the step of the difference
  double top = low;
  if (low < high) {
    const double step = (high - low) * 1e-7;
    double from = low, to = high - step;
    for (int i = 0; i < halvings_of_top && from < to; ++i) {
      const double middle = from + (to - from) / 2;
      (changing_time(middle) < changing_time(middle + step) ? from : to) = middle;
    }
    top = from;
  }
  const bool low_fits = changing_time(low) <= time, high_fits = changing_time(high) <= time;
  const bool is_one = low_fits && high_fits && changing_time(top) <= time;
  if (is_one) return cruise_between(outermost(low, -most, time), outermost(high, most, time), time);
  if (low_fits)
    if (const auto found = cruise_between(outermost(low, -most, time), outermost(low, top, time), time))
      return found;
  if (high_fits) return cruise_between(outermost(high, top, time), outermost(high, most, time), time);
  return {};
}

inline PointToPointMotion TimedMotion::motion(double time, double cruise) const {
  if (std::isnan(cruise)) return PointToPointMotion::between(from_, target_, limits_);
  const Changes both = changes(cruise);
  PointToPointMotion::Pieces pieces{};
  for (size_t i = 0; i < 3; ++i) {
    pieces[i] = both.first.pieces[i];
    const PointToPointMotion::Piece& mirrored = both.last.pieces[2 - i];
    // Backwards in time the velocity is the same, and its slope has the other sign.
    pieces[4 + i] = {mirrored.duration, -(mirrored.acceleration + mirrored.jerk * mirrored.duration),
                     mirrored.jerk};
  }
  pieces[3].duration = std::max(0.0, time - both.time());
  return PointToPointMotion::of_pieces(from_, pieces, target_, end_velocity_, time);
}

inline CommonMotion common_motion(std::span<const TimedMotion> axes) {
  double least = 0;
  for (const TimedMotion& axis : axes) least = std::max(least, axis.fastest());
  boost::container::static_vector<TimedMotion::Bound, TimedMotion::most_bounds * most_axes_together>
      candidates;
  for (const TimedMotion& axis : axes)
    for (const TimedMotion::Bound& bound : axis.bounds())
      if (bound.time >= least) candidates.push_back(bound);
  std::sort(candidates.begin(), candidates.end(),
            [](const auto& a, const auto& b) { return a.time < b.time; });
  for (const auto& [time, cruise] : candidates) {
    CommonMotion common{time, {}};
    for (const TimedMotion& axis : axes) {
      // At a bound of its own the axis has no slack that rounding would not take.
      std::optional<double> found = axis.cruise_for(time);
      for (const TimedMotion::Bound& bound : axis.bounds())
        if (bound.time == time) found = bound.cruise;
      if (!found) break;
      common.cruises.push_back(*found);
    }
    if (common.cruises.size() == axes.size()) return common;
  }
  CommonMotion none{HUGE_VAL, {}};
  none.cruises.resize(axes.size(), 0);
  return none;
}

}  // namespace loopwright
