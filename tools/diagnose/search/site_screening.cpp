#include "tools/diagnose/search/site_screening.h"
#include <algorithm>
#include <cmath>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {

void keep_best(std::vector<SiteHypothesis>& list, const SiteHypothesis& at, double share) {
  if (list.empty()) return;
  std::ranges::sort(list, {}, &SiteHypothesis::scaled_objective);
  const double best = list.front().scaled_objective;
  const double margin = std::max(criteria::least_behind, share * (at.scaled_objective - best));
  std::erase_if(list, [&](const SiteHypothesis& h) { return h.scaled_objective > best + margin; });
}

void leave_out_twins(std::vector<SiteCandidate>& list) {
  std::vector<SiteCandidate> kept;
  for (SiteCandidate& c : list) {
    const bool is_twin = std::ranges::any_of(kept, [&](const SiteCandidate& k) {
      return k.term.shape == c.term.shape && k.constant.has_value() == c.constant.has_value() &&
             std::abs(k.gain - c.gain) < criteria::same_gain * k.gain && c.cost > k.cost + criteria::dearer;
    });
    if (!is_twin) kept.push_back(std::move(c));
  }
  list = std::move(kept);
}

void leave_out_hopeless(std::vector<SiteCandidate>& list, const SiteTerm& term) {
  double own = 0;
  for (const SiteCandidate& c : list)
    if (c.is_same_key(term)) own = std::max(own, c.gain);
  std::erase_if(list, [&](const SiteCandidate& c) {
    return c.is_same_key(term) || c.gain < criteria::least_share_of_replaced * own;
  });
  leave_out_twins(list);
}

std::vector<SiteCandidate> worth_fitting(std::vector<SiteCandidate> ranked, size_t count) {
  const auto is_distortion = [](const SiteCandidate& c) { return c.term.shape->of == TermShape::Of::own; };
  const auto distortions =
      std::ranges::stable_partition(ranked, [&](const SiteCandidate& c) { return !is_distortion(c); });
  std::vector<SiteCandidate> list(distortions.begin(), distortions.begin() + (distortions.empty() ? 0 : 1));
  ranked.erase(distortions.begin(), ranked.end());
  ranked.resize(std::min(count, ranked.size()));
  std::ranges::move(ranked, std::back_inserter(list));
  return list;
}

}  // namespace loopwright::diagnosis
