/// Crossing functions that are never zero.
#pragma once
#include "engine/block.h"

namespace loopwright::blocks {

/// Positive exactly where u > 0, negative elsewhere. A crossing function that begins at zero has no sign to
/// change: a sine that starts at 0 would leave the piece where it is zero unseen. Numbers from 1e-284 up keep
/// their bits.
template <class Real> LW_INLINE Real above_zero(const Real& u) { return u - 1e-300; }

/// Positive where u ≥ 0, negative elsewhere.
template <class Real> LW_INLINE Real not_below_zero(const Real& u) { return u + 1e-300; }

}  // namespace loopwright::blocks
