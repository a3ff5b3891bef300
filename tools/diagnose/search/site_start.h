/// With what a search at the sites begins: the diagram as it is, sizes of its states and its best noise; and
/// the same with its parameters fitted.
#pragma once
#include <optional>
#include <vector>
#include "tools/diagnose/search/site_search.h"

namespace loopwright::diagnosis {

/// Parameters as stated and no terms. Returns the number of readings; nothing if it diverges along the
/// record.
std::optional<double> start_from_stated(SiteFitter& fitter, ErrorsOf errors,
                                        const std::vector<SlowNoise>& disturbances, SiteHypothesis& h);

/// Those parameters free that the record sees at all.
SiteHypothesis with_free_parameters(SiteFitter& fitter, SiteHypothesis h);

}  // namespace loopwright::diagnosis
