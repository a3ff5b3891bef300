/// A motion of several axes through points: all axes pass a point at the same instant, with a velocity of
/// their own and without acceleration, and are at rest at the first and the last one.
///
/// Between two points every axis moves as timed_motion.h describes, in the shortest time in which all axes
/// can. The velocities at the points are searched for: first one number for each point, the speed along a
/// tangent of the path (F. N. Fritsch, R. E. Carlson, SIAM Journal on Numerical Analysis 17, 1980: an axis
/// that turns round at a point has velocity 0 there), then the velocity of each axis. Each is the best for
/// the two parts that meet at the point, until nothing becomes shorter. No axis moves back between two
/// points. The result is never slower than stopping at every point, which is where the search begins.
#pragma once
#include <vector>
#include "models/motion/timed_motion.h"

namespace loopwright {

class ViaPointMotion {
 public:
  ViaPointMotion() = default;
  /// Two or more points of as many numbers as there are limits.
  ViaPointMotion(std::vector<std::vector<double>> points, std::vector<MotionLimits> limits);

  size_t axes() const { return limits_.size(); }
  size_t parts() const { return ends_.size(); }
  double duration() const { return ends_.empty() ? 0 : ends_.back(); }
  /// The part at a time since the start; parts() at the end.
  size_t part_at(double time) const {
    size_t part = 0;
    while (part < ends_.size() && !(time < ends_[part])) ++part;
    return part;
  }
  double begin_of(size_t part) const { return part == 0 ? 0 : ends_[part - 1]; }
  /// The motion of an axis in a part, with times since the begin of the part.
  const PointToPointMotion& motion(size_t part, size_t axis) const { return motions_[part][axis]; }
  MotionState state_at(double time, size_t axis) const {
    const size_t part = part_at(time);
    return part == parts() ? MotionState{points_.back()[axis], 0, 0}
                           : motions_[part][axis].state_at(time - begin_of(part));
  }
  /// Of an axis at a point.
  double velocity_at(size_t point, size_t axis) const { return velocities_[point][axis]; }

 private:
  std::vector<TimedMotion> axes_of(size_t part) const;
  double time_of(size_t part) const;
  double time_around(size_t point) const { return time_of(point - 1) + time_of(point); }
  std::vector<double> tangent_at(size_t point) const;
  bool improve_speed(size_t point, const std::vector<double>& tangent);
  bool improve_axis(size_t point, size_t axis);
  template <class Set> bool improve(size_t point, double low, double high, const Set& set);
  void search();

  std::vector<std::vector<double>> points_, velocities_;
  std::vector<MotionLimits> limits_;
  std::vector<std::vector<PointToPointMotion>> motions_;  // by part and axis
  std::vector<double> ends_;                              // of the parts
};

inline ViaPointMotion::ViaPointMotion(std::vector<std::vector<double>> points,
                                      std::vector<MotionLimits> limits)
    : points_(std::move(points)), limits_(std::move(limits)) {
  velocities_.assign(points_.size(), std::vector<double>(axes(), 0));
  search();
  double end = 0;
  for (size_t part = 0; part + 1 < points_.size(); ++part) {
    const std::vector<TimedMotion> moving = axes_of(part);
    const CommonMotion common = common_motion(moving);
    auto& motions = motions_.emplace_back();
    for (size_t i = 0; i < axes(); ++i)
      motions.push_back(moving[i].motion(common.duration, common.cruises[i]));
    ends_.push_back(end += common.duration);
  }
}

inline std::vector<TimedMotion> ViaPointMotion::axes_of(size_t part) const {
  std::vector<TimedMotion> result;
  for (size_t i = 0; i < axes(); ++i)
    result.emplace_back(MotionState{points_[part][i], velocities_[part][i], 0}, points_[part + 1][i],
                        velocities_[part + 1][i], limits_[i]);
  return result;
}

/// Infinity if an axis would move back.
inline double ViaPointMotion::time_of(size_t part) const {
  const std::vector<TimedMotion> moving = axes_of(part);
  const CommonMotion common = common_motion(moving);
  if (!std::isfinite(common.duration)) return HUGE_VAL;
  for (size_t i = 0; i < axes(); ++i) {
    const double way = points_[part + 1][i] - points_[part][i];
    constexpr double rounding = 1e-9;  // of the greatest velocity
    const double least = -rounding * limits_[i].velocity;
    // The velocity is extreme where a phase ends.
    const PointToPointMotion motion = moving[i].motion(common.duration, common.cruises[i]);
    for (int phase = 0; phase < PointToPointMotion::phases; ++phase) {
      const double velocity = motion.state_at(motion.end_of_phase(phase), phase).velocity;
      if ((way < 0 ? -velocity : velocity) < least || (way == 0 && velocity > -least)) return HUGE_VAL;
    }
  }
  return common.duration;
}

inline std::vector<double> ViaPointMotion::tangent_at(size_t point) const {
  std::vector<double> tangent;
  for (size_t i = 0; i < axes(); ++i) {
    const double before = points_[point][i] - points_[point - 1][i],
                 after = points_[point + 1][i] - points_[point][i];
    tangent.push_back(before * after > 0 ? 2 * before * after / (before + after) : 0);
  }
  return tangent;
}

/// Sets a variable of a point to its best value: a grid, then the neighborhood of its best number by golden
/// sections. Nothing changes if the present value is as good.
template <class Set> bool ViaPointMotion::improve(size_t point, double low, double high, const Set& set) {
  constexpr double enough = 1e-7;  // of the time, for another value to be taken
  const std::vector<double> present = velocities_[point];
  const double at_present = time_around(point);
  const auto cost = [&](double value) {
    set(value);
    return time_around(point);
  };
  constexpr int grid = 8, sections = 20;
  double best = low, least = HUGE_VAL;
  for (int i = 0; i <= grid; ++i) {
    const double value = low + (high - low) * i / grid, time = cost(value);
    if (time < least) best = value, least = time;
  }
  const double width = (high - low) / grid, golden = 0.6180339887498949;
  double a = std::max(low, best - width), b = std::min(high, best + width);
  double c = b - golden * (b - a), d = a + golden * (b - a), at_c = cost(c), at_d = cost(d);
  for (int i = 0; i < sections; ++i) {
    if (at_c < at_d)
      b = d, d = c, at_d = at_c, c = b - golden * (b - a), at_c = cost(c);
    else
      a = c, c = d, at_c = at_d, d = a + golden * (b - a), at_d = cost(d);
  }
  if (at_c < least) best = c, least = at_c;
  if (at_d < least) best = d, least = at_d;
  const bool is_better = least < at_present * (1 - enough);
  if (is_better)
    set(best);
  else
    velocities_[point] = present;
  return is_better;
}

inline bool ViaPointMotion::improve_speed(size_t point, const std::vector<double>& tangent) {
  double most = HUGE_VAL;
  for (size_t i = 0; i < axes(); ++i)
    if (tangent[i] != 0) most = std::min(most, limits_[i].velocity / std::fabs(tangent[i]));
  if (!std::isfinite(most)) return false;
  return improve(point, 0, most, [&](double speed) {
    for (size_t i = 0; i < axes(); ++i) velocities_[point][i] = speed * tangent[i];
  });
}

inline bool ViaPointMotion::improve_axis(size_t point, size_t axis) {
  const double most = limits_[axis].velocity, sign = tangent_at(point)[axis];
  if (sign == 0) return false;
  return improve(point, sign < 0 ? -most : 0, sign < 0 ? 0 : most,
                 [&](double velocity) { velocities_[point][axis] = velocity; });
}

inline void ViaPointMotion::search() {
  constexpr int most_rounds = 6;
  for (const bool by_axis : {false, true})
    for (int round = 0; round < most_rounds; ++round) {
      bool improved = false;
      for (size_t point = 1; point + 1 < points_.size(); ++point) {
        if (!by_axis) improved |= improve_speed(point, tangent_at(point));
        for (size_t i = 0; by_axis && i < axes(); ++i) improved |= improve_axis(point, i);
      }
      if (!improved) break;
    }
}

}  // namespace loopwright
