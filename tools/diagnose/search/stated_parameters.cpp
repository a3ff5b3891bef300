#include "tools/diagnose/search/stated_parameters.h"
#include <algorithm>
#include "tools/diagnose/search/site_screening.h"

namespace loopwright::diagnosis {
namespace {

constexpr size_t fitted_in_its_place = 3;  // candidates

}  // namespace

std::vector<StatedParameters> with_stated_parameters(SiteFitter& fitter, const SiteHypothesis& found,
                                                     const SiteHypothesis& nominal,
                                                     const FitsOfCandidates& fits) {
  std::vector<StatedParameters> list;
  const auto try_at = [&](const SiteHypothesis& at, std::optional<size_t> of) {
    std::vector<SiteCandidate> ranked = rank_terms(fitter, at, fitter.shapes());
    std::erase_if(ranked, [&](const SiteCandidate& c) {
      return c.term.shape->name == "linear" && !of;  // a parameter
    });
    leave_out_twins(ranked);
    ranked.resize(std::min(fitted_in_its_place, ranked.size()));
    for (SiteHypothesis& h : fits(at, ranked)) list.push_back({std::move(h), of});
  };
  if (found.terms.empty()) {
    try_at(nominal, {});
    return list;
  }
  SiteHypothesis stated = found;
  std::ranges::fill(stated.factors, 1.0);
  stated.is_free.assign(stated.is_free.size(), false);
  for (size_t t = 0; t < found.terms.size(); ++t) {
    SiteHypothesis without = stated;
    without.terms.erase(without.terms.begin() + std::ptrdiff_t(t));
    try_at(without, t);
  }
  return list;
}

}  // namespace loopwright::diagnosis
