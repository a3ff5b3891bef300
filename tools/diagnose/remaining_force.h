/// The force that a model leaves unexplained, by inverse dynamics: what people look at. Zero-phase filters
/// make it readable and biased on records with feedback; names and intervals come from the prediction errors
/// instead.
#pragma once
#include "tools/compare/machine.h"
#include "tools/diagnose/maximum_likelihood.h"

namespace loopwright::diagnosis {

/// Measured motion, filtered forward and backward, and what the nominal model lacks to explain it.
struct InverseDynamics {
  MeasuredMotion motion;
  Path path;                      ///< the same, as effects read it
  std::vector<double> net_force;  ///< of the nominal diagram, as recorded
  std::vector<double> residual;   ///< net force less inertia × acceleration
};

InverseDynamics inverse_dynamics(Trial& trial, double rest_speed);

/// The nominal residual less what the members consume, filtered below 80 Hz (or a tenth of the sampling
/// rate).
std::vector<double> residual_with(const Trial& trial, const InverseDynamics& inverse,
                                  const std::vector<Member>& members);

struct ResidualSize {
  double fitted = 0, held_out = 0;  ///< root of the mean square; held_out 0 without held-out rows
};
ResidualSize residual_size(const Trials& trials, const std::vector<InverseDynamics>& inverse,
                           const std::vector<Member>& members);

/// The residual that the noise alone would leave, from its spectrum.
double residual_floor(const Trials& trials, const Noise& noise);

/// Root of the mean squared error of the first measured port when the model is let run for so long from
/// states that were right, again and again.
double short_horizon_error(Trials& trials, const Estimate& estimate, double horizon_s = 0.1);

}  // namespace loopwright::diagnosis
