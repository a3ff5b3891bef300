/// One parameter of the diagram that is not as stated, as all that is wrong.
#pragma once
#include <vector>
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// The diagram as it is but for one parameter, for each of those that are free in `parameters`; best first.
/// Fits of all parameters together bend those that the record tells poorly, and the sets that are tried about
/// such a point miss a single one that is far from it. A hopeless one has the noise of the diagram as it is.
std::vector<SiteHypothesis> with_one_parameter(SiteFitter& fitter, const SiteHypothesis& nominal,
                                               const SiteHypothesis& parameters);
/// Which one it is.
int moved_parameter(const SiteHypothesis& one);

}  // namespace loopwright::diagnosis
