/// Hyper-parameters by maximum a posteriori: they maximize log evidence plus log prior.
#pragma once
#include <functional>
#include "models/gp/kernel.h"

namespace loopwright::gp {

/// Log-normal: log p ~ N(log median, log_deviation²), limited to [low, high]. The density is that of log p,
/// so the median is also the mode.
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
  double tolerance = 1e-6;     ///< change of the log posterior regarded as converged
};

/// Maximizes from the given kernel by sequential quadratic programming in the logarithms of the parameters
/// (NLopt's SLSQP; D. Kraft, 1988). The method is deterministic: the same inputs give the same result.
Fit fit(const EvidenceFunction& evidence, const Kernel& from, std::span<const Prior> priors,
        const FitOptions& options = {});

/// The magnitudes to be expected in the data, for default_priors().
struct DataScale {
  double label_deviation = 1;
  double period = 0;          ///< τ
  double velocity_range = 1;  ///< highest minus lowest velocity
  double velocity_step = 0;   ///< spacing of neighboring velocities; 0: continuous
};

/// The priors of one kernel, in the order of parameters_of(). s is the standard deviation of the labels.
/// Deviation: s for a term that depends on position, 0.3 s for others; noise 0.3 s (log deviation 0.7).
/// Lengths: periodic 1, along position τ/5, along velocity a third of the range (log deviation 0.5). A
/// velocity length has the velocity spacing as its lower limit: with a shorter length each velocity would be
/// learned separately, with no interpolation between them.
std::vector<Prior> default_priors(const Kernel& kernel, const DataScale& scale);

/// Every hyper-parameter at its median.
Kernel at_medians(const Kernel& kernel, std::span<const Prior> priors);

/// True if the result lies within a thousandth of the range (of the logarithm) of a limit.
bool is_at_limit(const Prior& prior, double value);

}  // namespace loopwright::gp
