/// A recorded input that gets to the machine late, as all that is missing.
#pragma once
#include <optional>
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// The diagram as it is with a delay or lag of one input, if that leaves white errors and explains the record
/// better than all parameters do. Such a term bends every parameter that is fitted without it, so that a
/// search that begins with free parameters takes long to come back to it.
std::optional<SiteHypothesis> explained_by_late_input(SiteFitter& fitter, const SiteHypothesis& nominal,
                                                      const SiteHypothesis& parameters);

}  // namespace loopwright::diagnosis
