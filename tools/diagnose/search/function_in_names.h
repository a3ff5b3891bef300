/// A function without a name that one or two names make up.
#pragma once
#include "tools/diagnose/search/stated_parameters.h"

namespace loopwright::diagnosis {

/// A distortion of a signal and a constant, say: each leaves much by itself, so that a search that adds one
/// at a time takes a function in their place. And a distortion alone may leave much until parameters that
/// moved are known. The last function without a name in a hypothesis is replaced by each of the best
/// distortions, alone and with a term beside it. Empty: there is no such function.
std::vector<SiteHypothesis> function_in_names(SiteFitter& fitter, const SiteHypothesis& found,
                                              const FitsOfCandidates& fits);

}  // namespace loopwright::diagnosis
