/// Crossing functions that are never exactly zero.
#pragma once
#include "engine/block.h"

namespace loopwright::blocks {

/// Positive exactly where u > 0, negative elsewhere. A crossing function that starts at zero has no sign to
/// change: for a sine that starts at 0, leaving zero would not be detected. Numbers from 1e-284 up keep their
/// bits.
template <class Real> LW_INLINE Real above_zero(const Real& u) { return u - 1e-300; }

/// Positive where u ≥ 0, negative elsewhere.
template <class Real> LW_INLINE Real not_below_zero(const Real& u) { return u + 1e-300; }

}  // namespace loopwright::blocks
