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
  for (size_t i = 0; i < parameters.is_free.size(); ++i) {
    if (!parameters.is_free[i]) continue;
    list.push_back(nominal);
    list.back().is_free[i] = true;
  }
  fitter.side_by_side(list.size(), [&](SiteFitter& own, size_t i) { own.refine(list[i], first_steps); });
  std::erase_if(list, [](const SiteHypothesis& one) { return !std::isfinite(one.objective); });
  std::ranges::stable_sort(list, {}, &SiteHypothesis::scaled_objective);
  fitter.side_by_side(std::min(fitted_with_noise, list.size()), [&](SiteFitter& own, size_t i) {
    own.anneal(list[i]);
    own.refine(list[i], further_steps);
  });
  std::ranges::stable_sort(list, {}, &SiteHypothesis::objective);
  return list;
}

int moved_parameter(const SiteHypothesis& one) {
  return int(std::ranges::find(one.is_free, true) - one.is_free.begin());
}

}  // namespace loopwright::diagnosis
