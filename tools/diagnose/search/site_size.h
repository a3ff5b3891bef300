/// Sizes along a pass with columns, as root mean squares.
#pragma once
#include "tools/diagnose/predict/site_filter.h"

namespace loopwright::diagnosis {

/// [unit of the site] Of the signal there; 0 if nobody knows it.
double size_at_site(const SiteModel& model, const SitePass& pass, int site);
/// [unit of the site]
double size_of_term(const SiteModel& model, const SitePass& pass, const SiteTerm& term);

}  // namespace loopwright::diagnosis
