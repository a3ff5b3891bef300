/// Whether the rows that were held out speak for each term that was found.
#pragma once
#include <vector>
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// The terms without which the held-out rows are predicted better, although these would show them. The fitter
/// is over the whole record.
std::vector<size_t> contradicted_terms(SiteFitter& whole, SiteHypothesis found);

}  // namespace loopwright::diagnosis
