/// The system for a solver: dx/dt = f(t, x) between discontinuities, and the locations of these.
#pragma once
#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace loopwright {

/// The continuous part of a run as seen by a variable-step solver. Plain function pointers: no allocation, no
/// exception. The system owns nothing of the solver; `self` is passed to every call. Both functions must have
/// no side effects, as solvers also try values that never become part of the solution. Both return false if a
/// block faulted at (t, x).
struct OdeSystem {
  void* self = nullptr;
  int states = 0;
  int crossings = 0;
  /// rate[states] := f(t, x[states]).
  bool (*derivatives)(void* self, double t, const double* x, double* rate) = nullptr;
  /// value[crossings] := the crossing functions at (t, x[states]), with piecewise constants held; a change of
  /// sign is an event.
  bool (*crossing_values)(void* self, double t, const double* x, double* value) = nullptr;
};

/// Copies the state of a system. Most have a few states, for which a call of memmove costs more than the
/// copy.
template <class Real, class To>
[[gnu::always_inline]] inline void copy_states(const Real* from, size_t count, To* to) {
  switch (count) {
    case 4:
      to[3] = from[3];
      [[fallthrough]];
    case 3:
      to[2] = from[2];
      [[fallthrough]];
    case 2:
      to[1] = from[1];
      [[fallthrough]];
    case 1:
      to[0] = from[0];
      [[fallthrough]];
    case 0:
      return;
    default:
      std::copy_n(from, count, to);
  }
}

/// The direction in which a crossing function must pass through zero to count.
enum class Crossing : int8_t { falling = -1, either = 0, rising = 1 };

}  // namespace loopwright
