#include "tools/diagnose/search/one_parameter.h"
#include <algorithm>
#include <cmath>

namespace loopwright::diagnosis {
namespace {

constexpr int first_steps = 4, further_steps = 3;
constexpr size_t fitted_with_noise = 3;  // the others are hopeless after the first steps

}  // namespace

std::vector<SiteHypothesis> with_one_parameter(SiteFitter& fitter, const SiteHypothesis& nominal,
                                               const SiteHypothesis& parameters) {
  std::vector<SiteHypothesis> list;
  for (size_t i = 0; i < parameters.is_free.size() && !fitter.is_interrupted(); ++i) {
    if (!parameters.is_free[i]) continue;
    SiteHypothesis one = nominal;
    one.is_free[i] = true;
    fitter.refine(one, first_steps);
    if (std::isfinite(one.objective)) list.push_back(std::move(one));
  }
  std::ranges::stable_sort(list, {}, &SiteHypothesis::scaled_objective);
  for (size_t i = 0; i < std::min(fitted_with_noise, list.size()); ++i) {
    fitter.anneal(list[i]);
    fitter.refine(list[i], further_steps);
  }
  std::ranges::stable_sort(list, {}, &SiteHypothesis::objective);
  return list;
}

int moved_parameter(const SiteHypothesis& one) {
  return int(std::ranges::find(one.is_free, true) - one.is_free.begin());
}

}  // namespace loopwright::diagnosis
