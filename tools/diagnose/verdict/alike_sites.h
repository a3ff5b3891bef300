/// What a record cannot show.
#pragma once
#include <string>
#include <vector>
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// A sentence for each pair of sites at which terms look alike in the measured outputs, and for each at which
/// no term shows.
std::vector<std::string> alike_sites(SiteFitter& fitter, SiteHypothesis hypothesis);

}  // namespace loopwright::diagnosis
