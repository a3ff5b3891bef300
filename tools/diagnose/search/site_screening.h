/// Which candidates are not worth the work of a real fit, or of all its steps.
#pragma once
#include <vector>
#include "tools/diagnose/search/site_ranking.h"

namespace loopwright::diagnosis {

/// Leaves those whose gain over `at` is behind that of the best one by no more than this share of it, best
/// first.
void keep_best(std::vector<SiteHypothesis>& list, const SiteHypothesis& at, double share);

/// The same law at another site or of another variable, at a price for which it can be neither the answer nor
/// a rival.
void leave_out_twins(std::vector<SiteCandidate>& list);

/// Of candidates for the place of a term, ranked without it: the term itself, what gains clearly less, and
/// twins.
void leave_out_hopeless(std::vector<SiteCandidate>& list, const SiteTerm& term);

/// The best distortion of a ranked list, which was judged at a few first values alone, and so many others.
std::vector<SiteCandidate> worth_fitting(std::vector<SiteCandidate> ranked, size_t count);

}  // namespace loopwright::diagnosis
