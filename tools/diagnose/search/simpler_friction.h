/// Dry friction that falls with speed against that which does not.
#pragma once
#include <functional>
#include <vector>
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// The terms whose friction does not fall with the speed, at the width that was found, where the criterion is
/// lower then: by itself that law may have been fitted from a worse one.
std::vector<size_t> simplify_friction(SiteFitter& fitter, SiteHypothesis& at,
                                      const std::function<double(const SiteHypothesis&)>& criterion);

}  // namespace loopwright::diagnosis
