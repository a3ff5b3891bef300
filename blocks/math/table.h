/// Shared by the tables over breakpoints.
#pragma once
#include <algorithm>
#include "blocks/math/sides.h"

namespace loopwright::blocks {

/// The result of a table outside its breakpoints.
enum class Outside { hold, extrapolate, fault };
constexpr auto names_of(Outside) { return std::array<std::string_view, 3>{"hold", "extrapolate", "fault"}; }

/// The interval of u: i for breakpoints[i] ≤ u < breakpoints[i+1], -1 below the first breakpoint, size - 1
/// from the last one on.
inline int interval_of(const std::vector<double>& breakpoints, double u) {
  return int(std::upper_bound(breakpoints.begin(), breakpoints.end(), u) - breakpoints.begin()) - 1;
}
/// The interval whose formula applies at u, from 0 to size - 2; outside, the first or last interval.
inline size_t inner_interval(const std::vector<double>& breakpoints, double u) {
  return size_t(std::clamp(interval_of(breakpoints, u), 0, int(breakpoints.size()) - 2));
}
/// The distance of u from the borders of an interval; where there is no border, a number of constant sign.
inline double above_border(const std::vector<double>& breakpoints, int interval, double u) {
  return interval < 0 ? 1.0 : not_below_zero(u - breakpoints[size_t(interval)]);
}
inline double below_border(const std::vector<double>& breakpoints, int interval, double u) {
  const size_t next = size_t(interval + 1);
  return next < breakpoints.size() ? not_below_zero(u - breakpoints[next]) : -1.0;
}

inline void check_breakpoints(const Checker& checker, std::string_view name,
                              const std::vector<double>& breakpoints) {
  if (breakpoints.size() < 2) {
    auto& p = checker.error(name, "a table needs at least two breakpoints");
    p.found = std::to_string(breakpoints.size());
  }
  for (size_t i = 1; i < breakpoints.size(); ++i) {
    if (breakpoints[i] > breakpoints[i - 1]) continue;
    auto& p = checker.error(name, "breakpoints must rise strictly");
    p.found = reading::number_text(breakpoints[i - 1]) + ", " + reading::number_text(breakpoints[i]) +
              " at index " + std::to_string(i);
    return;
  }
}

}  // namespace loopwright::blocks
