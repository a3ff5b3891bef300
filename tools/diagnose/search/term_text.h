/// Terms in words.
#pragma once
#include <string>
#include <vector>
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// As in "net.sum: square(rotor.velocity)".
std::string describe(const SiteModel& model, const SiteTerm& term);
/// Its terms, then the parameters that moved.
std::vector<std::string> named_in(const SiteModel& model, const SiteHypothesis& h);

}  // namespace loopwright::diagnosis
