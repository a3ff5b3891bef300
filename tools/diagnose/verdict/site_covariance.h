/// How well a record tells the numbers of a hypothesis about any diagram.
#pragma once
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// Covariance of all fitted numbers, in the order of fitted_numbers(); infinite for those that the record
/// does not tell.
Eigen::MatrixXd covariance_of(SiteFitter& fitter, SiteHypothesis hypothesis);

}  // namespace loopwright::diagnosis
