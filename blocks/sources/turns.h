/// Phase and period of repeating signals.
#pragma once
#include "engine/block.h"
#include "models/real/exact_times.h"

namespace loopwright::blocks {

/// sin(2π turns + phase), phase in rad. Whole turns are subtracted first, so that the phase is as exact after
/// an hour as in the first second.
template <class Real> LW_INLINE Real sine_of_turns(const Real& turns, const Real& phase) {
  return sine(2.0 * pi * (turns - round_even(turns)) + phase);
}

}  // namespace loopwright::blocks
