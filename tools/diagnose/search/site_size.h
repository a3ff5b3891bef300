/// Sizes along a pass with columns, as root mean squares.
#pragma once
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// [unit of the site] Of the signal there; 0 if nobody knows it.
double size_at_site(const SiteModel& model, const SitePass& pass, int site);
/// [unit of the site]
double size_of_term(const SiteModel& model, const SitePass& pass, const SiteTerm& term);

/// Terms of a hypothesis that are more than nothing. Without noise every rest of the arithmetic is
/// significant: what is far below the signal at its site is no effect.
std::vector<size_t> terms_that_are_something(SiteFitter& fitter, SiteHypothesis h);

}  // namespace loopwright::diagnosis
