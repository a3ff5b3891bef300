#include "tools/diagnose/search/simpler_friction.h"
#include <algorithm>

namespace loopwright::diagnosis {

std::vector<size_t> simplify_friction(SiteFitter& fitter, SiteHypothesis& at,
                                      const std::function<double(const SiteHypothesis&)>& criterion) {
  std::vector<size_t> simplified;
  const auto sign = std::ranges::find(fitter.shapes(), "sign", &TermShape::name);
  for (size_t t = 0; t < at.terms.size() && sign != fitter.shapes().end(); ++t) {
    if (at.terms[t].shape->name != "stribeck") continue;
    SiteHypothesis simple = at;
    simple.terms[t].shape = &*sign;
    fitter.refine(simple, 6);
    fitter.fit_noise(simple);
    if (!(criterion(simple) < criterion(at))) continue;
    at = std::move(simple);
    simplified.push_back(t);
  }
  return simplified;
}

}  // namespace loopwright::diagnosis
