/// Slow disturbances at the sites of noise: drafts, drifting amplifiers and rolling bearings leave errors
/// that are not white whatever is added to the diagram, and terms are bent to follow them.
#pragma once
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// Whether nothing is left in the errors that one more prediction could use.
bool leaves_white_errors(SiteFitter& fitter, SiteHypothesis h);

/// The hypothesis with slow disturbances, one site after the other, at most so many, until its errors are
/// white or no further one helps.
SiteHypothesis with_disturbances(SiteFitter& fitter, SiteHypothesis h, size_t most);

/// The hypothesis without those that its terms made unnecessary.
SiteHypothesis without_idle_disturbances(SiteFitter& fitter, SiteHypothesis h);

/// A disturbance as it was along the record.
struct Disturbance {
  int site;
  double size;   ///< [unit of the site] rms
  double share;  ///< of the signal there
  double time;   ///< [s] for which it is alike
  /// More of it may stand for an effect that is missing.
  bool is_small() const;
};
std::vector<Disturbance> disturbances_of(SiteFitter& fitter, SiteHypothesis h);

/// Whether its errors are white beside disturbances that are small.
bool is_explained_by_small_disturbances(SiteFitter& fitter, const SiteHypothesis& h);

}  // namespace loopwright::diagnosis
