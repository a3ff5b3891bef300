/// Gains of stable linear systems over all signals, for bounds on loops.
#pragma once
#include "models/linear/state_space.h"

namespace loopwright {

/// A number known to lie between the two; a certificate may use the upper one.
struct Bounds {
  double lower = 0, upper = 0;
};

/// Gain from the largest |u| to the largest |y| of a stable sampled system with one input and one output: Σ
/// |h[k]|. The sum ends when a bound on the remaining terms, from powers of A with a norm below 1, is less
/// than `tolerance` of it. Throws std::domain_error for an unstable system, std::invalid_argument for a
/// continuous one. Sample a continuous system finely: the sum is then the integral of |h|, except for the
/// samples in which h changes its sign.
Bounds peak_to_peak_gain(const StateSpace& system, double tolerance = 1e-6);

/// Gain from the energy of u to the energy of y of a stable system with any number of inputs and outputs: the
/// largest singular value over all frequencies. The upper bound is proven by the eigenvalues of a Hamiltonian
/// matrix (N. A. Bruinsma, M. Steinbuch, Systems & Control Letters 14, 1990); sampled systems are mapped by
/// the bilinear transformation. Throws std::domain_error for an unstable system.
Bounds energy_gain(const StateSpace& system, double tolerance = 1e-4);

}  // namespace loopwright
