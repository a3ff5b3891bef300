/// The diagram as it is, with which a search at the sites begins: sizes of its states, and its best noise.
#pragma once
#include <optional>
#include <vector>
#include "tools/diagnose/search/site_search.h"

namespace loopwright::diagnosis {

/// Parameters as stated and no terms. Returns the number of readings; nothing if it diverges along the
/// record.
std::optional<double> start_from_stated(SiteFitter& fitter, ErrorsOf errors,
                                        const std::vector<SlowNoise>& disturbances, SiteHypothesis& h);

}  // namespace loopwright::diagnosis
