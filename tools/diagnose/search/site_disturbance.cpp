#include "tools/diagnose/search/site_disturbance.h"
#include <algorithm>
#include <cmath>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/site_size.h"
#include "tools/diagnose/search/site_whiteness.h"

namespace loopwright::diagnosis {
namespace {

using criteria::least_gain_of_disturbance;

/// Along the rows in which the filter has settled.
double root_mean_square(const SitePass& pass, size_t state, const std::vector<bool>& settles) {
  double square = 0, count = 0;
  for (size_t k = 0; k < pass.rows; ++k)
    if (!settles[k]) square += squared(pass.filtered[k * pass.states + state]), count += 1;
  return std::sqrt(square / count);
}

}  // namespace

bool leaves_white_errors(SiteFitter& fitter, SiteHypothesis h) {
  SitePass pass;
  return fitter.pass(h, false, pass) &&
         portmanteau_beside_counts(pass, fitter.model().record()) < criteria::most_portmanteau_of_any_diagram;
}

SiteHypothesis with_disturbances(SiteFitter& fitter, SiteHypothesis h, size_t most) {
  while (h.noise.slow.size() < most && !fitter.is_interrupted() && !leaves_white_errors(fitter, h)) {
    SiteHypothesis best = h;
    for (int site : h.noise.sites) {
      if (std::ranges::find(h.noise.slow, site, &SlowNoise::site) != h.noise.slow.end()) continue;
      SiteHypothesis trial = h;
      trial.noise = fitter.filter().with_disturbance(h.noise, site);
      fitter.fit_noise(trial);
      if (trial.objective < best.objective) best = std::move(trial);
    }
    if (!(best.objective < h.objective - least_gain_of_disturbance)) break;
    h = std::move(best);
    fitter.refine(h, 4);
    fitter.fit_noise(h);
  }
  return h;
}

SiteHypothesis without_idle_disturbances(SiteFitter& fitter, SiteHypothesis h) {
  for (size_t j = h.noise.slow.size(); j-- > 0;) {
    SiteHypothesis without = h;
    without.noise.slow.erase(without.noise.slow.begin() + std::ptrdiff_t(j));
    fitter.refine(without, 4);
    fitter.fit_noise(without);
    if (without.objective - h.objective < least_gain_of_disturbance) h = std::move(without);
  }
  return h;
}

bool Disturbance::is_small() const { return share <= criteria::most_slow_disturbance; }

std::vector<Disturbance> disturbances_of(SiteFitter& fitter, SiteHypothesis h) {
  std::vector<Disturbance> list;
  SitePass pass;
  if (h.noise.slow.empty() || h.noise.is_of_simulation || !fitter.pass(h, true, pass)) return list;
  const std::vector<bool> settles = fitter.model().record().settling_rows();
  for (size_t j = 0; j < h.noise.slow.size(); ++j) {
    const SlowNoise& slow = h.noise.slow[j];
    const double size = root_mean_square(pass, size_t(fitter.model().states()) + j, settles);
    list.push_back({slow.site, size, size / size_at_site(fitter.model(), pass, slow.site), slow.time});
  }
  return list;
}

bool is_explained_by_small_disturbances(SiteFitter& fitter, const SiteHypothesis& h) {
  return leaves_white_errors(fitter, h) &&
         std::ranges::all_of(disturbances_of(fitter, h), &Disturbance::is_small);
}

}  // namespace loopwright::diagnosis
