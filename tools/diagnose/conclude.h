/// After the search: noise and parameters by maximum likelihood, what is material, what else would do.
#pragma once
#include "tools/diagnose/evidence.h"

namespace loopwright::diagnosis {

/// What speaks for one member, and how much it does.
struct Weight {
  double wald = 0;       ///< χ²: squared distance from zero in standard deviations
  double force_rms = 0;  ///< of what it consumes, over the fitted rows; of a sensor: the force that it feigns
  double unique_force = 0;  ///< the part of it that no other member could take over
  double loss = 0;          ///< what the criterion loses without it
};

/// An estimate with noise as given gets its covariance, and every member its weight.
std::vector<Weight> weigh_all(Trials& trials, Estimate& estimate);

/// How far a member lies above every threshold of certainty and force; below one it is not taken in.
double material(const Trials& trials, const Estimate& estimate, const Weight& weight);

struct Substitute {
  const Candidate* candidate = nullptr;
  double loss = 0;  ///< how much worse the criterion is with it; negative: better
};

/// Members that others together could replace, two for one or two or one for two.
struct OtherSet {
  std::vector<const Candidate*> replaced, by;
  double loss = 0;  ///< how much worse the criterion is with it
};

/// Above it the errors are not white. Counts of an encoder that pass at a steady speed alone make up to 170.
constexpr double most_portmanteau = 300;
constexpr size_t portmanteau_lags = 40;

struct Conclusion {
  Estimate estimate;
  std::vector<Weight> weights;                       ///< a member each
  std::vector<std::vector<Substitute>> substitutes;  ///< within reach, best first
  std::vector<OtherSet> other_sets;                  ///< within reach, best first
  std::vector<double> inclusion;                     ///< probability that the effect is there, calibrated
  bool is_remainder_noise = true;                    ///< else a slow force is left that is more than noise
  double portmanteau = 0;          ///< n Σ ρ², 40 lags of the whitened errors; 40 when white
  std::vector<std::string> trail;  ///< what was taken out, and why

  /// Whether nothing is left in the errors.
  bool is_white() const { return is_remainder_noise && portmanteau <= most_portmanteau; }
};

/// Joint maximum likelihood of parameters and noise, immaterial members taken out one by one.
Conclusion conclude(Trials& trials, const std::vector<Candidate>& candidates,
                    const std::vector<Shape>& shapes, Estimate found);

/// n Σ ρ² over 40 lags; near 40 when nothing is left in the errors.
double portmanteau(const Trials& trials, const std::vector<Fitted>& fitted);

}  // namespace loopwright::diagnosis
