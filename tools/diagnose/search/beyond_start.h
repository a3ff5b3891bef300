/// What a hypothesis explains once the filter has settled.
#pragma once
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// -2 ln L of the fitted rows behind the start of each record. There, little is known of states that are not
/// measured, and a strong law misleads the filter about them: terms that act in these rows alone would mend
/// it.
double objective_beyond_start(SiteFitter& fitter, SiteHypothesis hypothesis);

}  // namespace loopwright::diagnosis
