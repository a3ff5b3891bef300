/// Phase and period of signals that repeat.
#pragma once
#include "engine/block.h"

namespace loopwright::blocks {

/// sin(2π turns + phase), phase in rad. Whole turns are taken off first, so that the phase is as exact after
/// an hour as in the first second.
template <class Real> LW_INLINE Real sine_of_turns(const Real& turns, const Real& phase) {
  return sine(2.0 * pi * (turns - round_even(turns)) + phase);
}

/// The greatest whole k with start + k · period ≤ time, in that very rounding: a time that next_stop works
/// out by the same expression is inside the period that it begins.
template <class Real> LW_INLINE Real whole_periods(const Real& time, const Real& start, const Real& period) {
  const Real k = floor_of((time - start) / period);
  return select(start + k * period > time, k - 1.0, select(start + (k + 1.0) * period <= time, k + 1.0, k));
}

}  // namespace loopwright::blocks
