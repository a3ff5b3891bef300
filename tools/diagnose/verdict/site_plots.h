/// What the page of a diagnosis without roles draws, beside its tables.
#pragma once
#include "tools/diagnose/diagnosis.h"
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// Adds terms and whiteness to the answer. Each term with a name is drawn with what the record says without
/// it: a function of straight lines between nodes at its site, fitted by least squares to the prediction
/// errors along the pass of the whole answer. Nodes that the record hardly tells are left out.
void add_site_plots(SiteFitter& fitter, const SiteHypothesis& nominal, const SiteHypothesis& found,
                    Diagnosis& result);

}  // namespace loopwright::diagnosis
