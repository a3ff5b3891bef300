/// The force that a model leaves unexplained, by inverse dynamics, for display. Zero-phase filters make it
/// readable but biased on records with feedback; names and intervals come from the prediction errors instead.
#pragma once
#include "tools/compare/machine.h"
#include "tools/diagnose/search/maximum_likelihood.h"

namespace loopwright::diagnosis {

/// Measured motion, filtered forward and backward, and the force that the nominal model lacks to explain it.
struct InverseDynamics {
  MeasuredMotion motion;
  Path path;                      ///< the same, as the effects use it
  std::vector<double> net_force;  ///< of the nominal diagram, as recorded
  std::vector<double> residual;   ///< net force minus inertia × acceleration
};

InverseDynamics inverse_dynamics(Trial& trial, double rest_speed);

/// The nominal residual minus the force that the members consume, filtered below 80 Hz (or a tenth of the
/// sampling rate).
std::vector<double> residual_with(const Trial& trial, const InverseDynamics& inverse,
                                  const std::vector<Member>& members);

struct ResidualSize {
  double fitted = 0, held_out = 0;  ///< root mean square; held_out 0 without held-out rows
};
ResidualSize residual_size(const Trials& trials, const std::vector<InverseDynamics>& inverse,
                           const std::vector<Member>& members);

/// The residual that the noise alone would leave, from its spectrum.
double residual_floor(const Trials& trials, const Noise& noise);

/// Root mean squared error of the first measured port when the model runs freely for this time, repeatedly
/// started from correct states.
double short_horizon_error(Trials& trials, const Estimate& estimate, double horizon_s = 0.1);

}  // namespace loopwright::diagnosis
