/// Limits of several axes, as blocks state them.
#pragma once
#include <limits>
#include <string>
#include <vector>
#include "engine/block.h"
#include "models/motion/timed_motion.h"

namespace loopwright::blocks {

constexpr size_t most_axes = most_axes_together;

/// The axes are those of `velocity`; without `jerk` velocities are trapezoids.
struct AxisLimits {
  std::vector<double> velocity, acceleration, jerk;

  MotionLimits of_axis(size_t i) const {
    return {velocity[i], acceleration[i], jerk.empty() ? HUGE_VAL : jerk[i]};
  }
  std::vector<MotionLimits> of_each() const {
    std::vector<MotionLimits> limits;
    for (size_t i = 0; i < velocity.size(); ++i) limits.push_back(of_axis(i));
    return limits;
  }
};

/// Reports a list that does not have a number for each axis.
inline void check_axes(const Checker& checker, std::string_view parameter, size_t numbers, size_t axes) {
  if (numbers == axes) return;
  auto& problem = checker.error(parameter, "there is not one number for each axis");
  problem.expected = std::to_string(axes) + ", one for each of \"velocity\"";
  problem.found = std::to_string(numbers);
}
inline void check_limits(const Checker& checker, const AxisLimits& limits) {
  const size_t axes = limits.velocity.size();
  if (axes < 1 || axes > most_axes)
    checker.error("velocity", "the number of axes is not possible").expected =
        "one number for each axis, for 1 to " + std::to_string(most_axes) + " axes";
  check_axes(checker, "acceleration", limits.acceleration.size(), axes);
  if (!limits.jerk.empty()) check_axes(checker, "jerk", limits.jerk.size(), axes);
}

}  // namespace loopwright::blocks
