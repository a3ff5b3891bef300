/// Crossing functions that are never exactly zero, and decisions that NaN must not pass.
#pragma once
#include "engine/block.h"

namespace loopwright::blocks {

/// Positive exactly where u > 0, negative elsewhere. A crossing function that starts at zero has no sign to
/// change: for a sine that starts at 0, leaving zero would not be detected. Where a mode depends on the sign,
/// the crossing function must have at zero the sign of the side that `decide` counts zero to. Numbers from
/// 1e-284 up keep their bits.
template <class Real> LW_INLINE Real above_zero(const Real& u) { return u - 1e-300; }

/// Positive where u ≥ 0, negative elsewhere.
template <class Real> LW_INLINE Real not_below_zero(const Real& u) { return u + 1e-300; }

/// Every comparison with NaN is false: without a fault a decision would look like that of a number on one
/// side.
template <class... Real> LW_INLINE Fault fault_if_nan(const Real&... inputs) {
  return fault_if(((inputs != inputs) | ...), "an input is NaN, which cannot be compared");
}

}  // namespace loopwright::blocks
