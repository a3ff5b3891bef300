/// What a record cannot show.
#pragma once
#include <string>
#include <vector>
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// A sentence for sites at which terms look alike in the measured outputs, and for each at which no term
/// shows.
std::vector<std::string> alike_sites(SiteFitter& fitter, SiteHypothesis hypothesis);

/// A sentence for each two laws in proportion to two signals at one site: their product is such a sum near
/// one point of operation.
std::vector<std::string> possible_products(const SiteModel& model, const SiteHypothesis& hypothesis);

/// What does the same as a term because a recorded input never comes near zero: a dead zone of the input that
/// is never entered is a constant, and the other way round.
std::vector<SiteTerm> same_beside_zero(SiteFitter& fitter, SiteHypothesis hypothesis, size_t term);

}  // namespace loopwright::diagnosis
