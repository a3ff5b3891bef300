/// Checks whether a fixed step is short enough for the fastest pole of the continuous part.
#pragma once
#include "engine/run/run.h"

namespace loopwright {

struct FastestPole {
  double magnitude = 0;  ///< |λ| [rad/s]; 0: no states, or too many to compute
  double real = 0, imaginary = 0;
  int state = -1;  ///< the state with the largest participation
};

/// Eigenvalues of the Jacobian by central differences, at the present time and states of the run, with modes
/// held.
FastestPole fastest_pole(Run<double>& run);

/// A sentence that names the block if the step of the plan is too long for the pole; otherwise empty.
std::string step_warning(const Plan& plan, const FastestPole& pole);

}  // namespace loopwright
