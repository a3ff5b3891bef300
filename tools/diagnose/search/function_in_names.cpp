#include "tools/diagnose/search/function_in_names.h"
#include <algorithm>
#include "tools/diagnose/search/site_screening.h"

namespace loopwright::diagnosis {

std::vector<SiteHypothesis> function_in_names(SiteFitter& fitter, const SiteHypothesis& found,
                                              const FitsOfCandidates& fits) {
  constexpr size_t distortions = 2, beside_each = 2;
  constexpr int steps_without = 3;  // Gauss-Newton
  const auto is_function = [](const SiteTerm& term) { return is_unknown_function(*term.shape); };
  const auto last = std::find_if(found.terms.rbegin(), found.terms.rend(), is_function);
  if (last == found.terms.rend()) return {};
  SiteHypothesis rest = without(found, size_t(found.terms.rend() - last) - 1);
  fitter.refine(rest, steps_without);  // what candidates gain counts from there
  fitter.fit_noise(rest);
  std::vector<SiteCandidate> ranked = rank_terms(fitter, rest, fitter.shapes());
  std::erase_if(ranked, [](const SiteCandidate& c) { return c.term.shape->of != TermShape::Of::own; });
  ranked.resize(std::min(distortions, ranked.size()));
  std::vector<SiteHypothesis> list;
  for (const SiteHypothesis& distorted : fits(rest, ranked)) {
    list.push_back(distorted);
    std::vector<SiteCandidate> second = rank_terms(fitter, distorted, fitter.shapes());
    leave_out_twins(second);
    second.resize(std::min(beside_each, second.size()));
    std::ranges::move(fits(distorted, second), std::back_inserter(list));
  }
  return list;
}

}  // namespace loopwright::diagnosis
