/// Whether a fixed step is short enough for the fastest pole of the continuous part.
#pragma once
#include "engine/run/run.h"

namespace loopwright {

struct FastestPole {
  double magnitude = 0;  ///< |λ| [rad/s]; 0: no states, or too many to look at
  double real = 0, imaginary = 0;
  int state = -1;  ///< the state that takes part most
};

/// Eigenvalues of the Jacobian by central differences, at the run's present time and states, modes held.
FastestPole fastest_pole(Run<double>& run);

/// A sentence that names the block when the plan's step is too long for the pole; empty when it is short
/// enough.
std::string step_warning(const Plan& plan, const FastestPole& pole);

}  // namespace loopwright
