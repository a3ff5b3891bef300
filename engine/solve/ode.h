/// What a solver needs to know of a system: dx/dt = f(t, x) between discontinuities, and where they are.
#pragma once
#include <cstdint>

namespace loopwright {

/// The continuous part of a run, seen by a variable-step solver. Plain function pointers: no allocation, no
/// exception. The system owns nothing of the solver; `self` is handed back on every call. Both functions are
/// side-effect free, for solvers try values that never become part of the solution. Both return false if a
/// block faulted at (t, x).
struct OdeSystem {
  void* self = nullptr;
  int states = 0;
  int crossings = 0;
  /// rate[states] := f(t, x[states]).
  bool (*derivatives)(void* self, double t, const double* x, double* rate) = nullptr;
  /// value[crossings] := the crossing functions at (t, x[states]), piecewise constants held; a change of sign
  /// is an event.
  bool (*crossing_values)(void* self, double t, const double* x, double* value) = nullptr;
};

/// Which way a crossing function must go through zero to count.
enum class Crossing : int8_t { falling = -1, either = 0, rising = 1 };

}  // namespace loopwright
