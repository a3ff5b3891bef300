/// What a solver needs to know of a system: dx/dt = f(t, x) between discontinuities, and where they are.
#pragma once
#include <cstdint>
#include <limits>
#include <string>

namespace loopwright {

/// The continuous part of a run, seen by a variable-step solver. Plain function pointers: no allocation, no exception.
/// The system owns nothing of the solver; `self` is handed back on every call.
struct OdeSystem {
  void* self = nullptr;
  int states = 0;
  int crossings = 0;
  /// rate := f(t, x). Side-effect free: trial values leave no trace. Returns false if a block faulted.
  bool (*derivatives)(void* self, double t, const double* x, double* rate) = nullptr;
  /// value := the crossing functions at (t, x), piecewise constants held; a change of sign is an event.
  bool (*crossing_values)(void* self, double t, const double* x, double* value) = nullptr;
};

/// Which way a crossing function must go through zero to count.
enum class Crossing : int8_t { falling = -1, either = 0, rising = 1 };

}  // namespace loopwright
