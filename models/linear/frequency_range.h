/// The frequencies at which the response of a system is worth looking at.
#pragma once
#include "models/linear/state_space.h"

namespace loopwright {

/// `count` frequencies (rad/s), spaced logarithmically from a decade below the slowest pole to a decade above
/// the fastest, or to the Nyquist frequency, and more of them around every lightly damped pole. `lifted` as
/// in FrequencyResponse.
std::vector<double> interesting_frequencies(const StateSpace& system, int count, int lifted = 1);

/// The same for the gain L of a loop with negative feedback: the poles of the closed loop count too, and the
/// range reaches so far that |L| does not cross 1 beyond its ends. The crossover of a fast loop is far above
/// the poles of L, that of a slow loop far below them.
std::vector<double> loop_frequencies(const StateSpace& loop_gain, int count, int lifted = 1);

}  // namespace loopwright
