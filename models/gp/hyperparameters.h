/// Hyper-parameters by maximum a posteriori: the greatest log evidence plus log prior.
#pragma once
#include <functional>
#include "models/gp/kernel.h"

namespace loopwright::gp {

/// Log-normal: log p ~ N(log median, log_deviation²), kept between low and high. The density is the one of
/// log p, so the median is also where it is greatest.
struct Prior {
  double median = 1;
  double log_deviation = 0.7;
  double low = 0, high = 0;
};

/// Log density of the logarithms of the parameters, without its constant, and its derivatives.
Evidence log_prior(std::span<const Prior> priors, std::span<const double> parameters);

struct Fit {
  Kernel kernel;
  Evidence evidence;     ///< log evidence, without the prior, at the result
  double objective = 0;  ///< with the prior
  int evaluations = 0;
  bool converged = false;
};

using EvidenceFunction = std::function<Evidence(const Kernel&)>;

struct FitOptions {
  int most_evaluations = 200;  ///< a fit of six parameters takes 20 to 40
  double tolerance = 1e-6;     ///< change of the log posterior that says nothing any more
};

/// From the kernel given, by sequential quadratic programming in the logarithms of the parameters (NLopt's
/// SLSQP; D. Kraft, 1988). Nothing random: the same inputs give the same result.
Fit fit(const EvidenceFunction& evidence, const Kernel& from, std::span<const Prior> priors,
        const FitOptions& options = {});

/// What sizes are to be expected in the data, for default_priors().
struct DataScale {
  double label_deviation = 1;
  double period = 0;          ///< τ
  double velocity_range = 1;  ///< from the slowest to the fastest
  double velocity_step = 0;   ///< between neighbouring velocities; 0: continuous
};

/// The priors of one kernel, in the order of parameters_of(). With s the deviation of the labels:
/// deviation of a term that sees the position s, of others 0.3 s, noise 0.3 s (log deviation 0.7);
/// periodic length 1, length along position τ/5, along velocity a third of the range (log deviation 0.5).
/// A velocity length may not fall below one step between velocities: shorter, it would learn each velocity
/// by itself and know nothing in between.
std::vector<Prior> default_priors(const Kernel& kernel, const DataScale& scale);

/// Every hyper-parameter at its median.
Kernel at_medians(const Kernel& kernel, std::span<const Prior> priors);

/// A parameter whose result lies within a thousandth (in its logarithm's range) of a limit.
bool is_at_limit(const Prior& prior, double value);

}  // namespace loopwright::gp
