/// Gains of stable linear systems over all signals: what bounds on loops are made of.
#pragma once
#include "models/linear/state_space.h"

namespace loopwright {

/// A number known to lie in between; the upper end is what a certificate may use.
struct Bounds {
  double lower = 0, upper = 0;
};

/// Gain from the largest |u| to the largest |y| of a stable sampled system, one input and one output:
/// Σ |h[k]|. Summed until a bound on what is left, from powers of A whose norm is below 1, adds less than
/// `tolerance` of it. Throws std::domain_error for an unstable system, std::invalid_argument for a continuous
/// one (sample it finely: the sum is then the integral of |h|, but for the samples in which h changes its
/// sign).
Bounds peak_to_peak_gain(const StateSpace& system, double tolerance = 1e-6);

/// Gain from the energy of u to the energy of y of a stable system, any number of inputs and outputs: the
/// largest singular value over all frequencies. The upper end is proven by the eigenvalues of a Hamiltonian
/// matrix (N. A. Bruinsma, M. Steinbuch, Systems & Control Letters 14, 1990), sampled systems by the bilinear
/// map. Throws std::domain_error for an unstable system.
Bounds energy_gain(const StateSpace& system, double tolerance = 1e-4);

}  // namespace loopwright
