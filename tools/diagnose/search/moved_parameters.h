/// Which parameters of a diagram are not as it states.
#pragma once
#include <vector>
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// In the criterion, beside ln n for each that moved.
inline constexpr double cost_of_parameter = 4;

struct MovedParameters {
  SiteHypothesis hypothesis;  ///< the others exactly as the diagram states
  double criterion = 0;
  std::vector<double> standard_errors = {};  ///< of those that moved, [of the parameter]

  std::vector<int> moved() const { return hypothesis.moved(); }
};

/// Sets of moved parameters by their criterion, best first, each fitted with its own noise. Sets are chosen
/// by the quadratic form of the likelihood: fixing parameters with deviations Δ costs Δᵀ Cov⁻¹ Δ.
std::vector<MovedParameters> moved_parameters(SiteFitter& fitter, const SiteHypothesis& all_free,
                                              double readings);

}  // namespace loopwright::diagnosis
