#include "tools/diagnose/search/stated_parameters.h"
#include <algorithm>
#include "tools/diagnose/search/site_screening.h"

namespace loopwright::diagnosis {
namespace {

constexpr size_t fitted_in_its_place = 3;  // candidates

class Replacement {
 public:
  Replacement(SiteFitter& fitter, const FitsOfCandidates& fits) : fitter_(fitter), fits_(fits) {}

  /// `of_several`: changes; a proportion in the place of a single parameter is that parameter.
  void try_at(const SiteHypothesis& at, std::optional<size_t> of, bool of_several, size_t added = 1) {
    std::vector<SiteCandidate> ranked = rank_terms(fitter_, at, fitter_.shapes());
    std::erase_if(ranked,
                  [&](const SiteCandidate& c) { return c.term.shape->name == "linear" && !of_several; });
    leave_out_twins(ranked);
    ranked.resize(std::min(fitted_in_its_place, ranked.size()));
    for (SiteHypothesis& h : fits_(at, ranked)) list_.push_back({std::move(h), of, added});
  }
  /// A law with an offset, as radiation has one, may stand for a constant and another law.
  void try_with_constant(const SiteHypothesis& at, size_t of, int site) {
    const auto constant = std::ranges::find(fitter_.shapes(), "constant", &TermShape::name);
    if (constant == fitter_.shapes().end()) return;
    const std::span<const TermShape> shapes{&*constant, 1};
    const std::vector<SiteCandidate> ranked = rank_terms_at(fitter_, at, shapes, site, -1);
    const std::vector<SiteHypothesis> fitted = fits_(at, ranked);
    if (!fitted.empty()) try_at(fitted.front(), of, true, 2);
  }
  std::vector<StatedParameters> take() { return std::move(list_); }

 private:
  SiteFitter& fitter_;
  const FitsOfCandidates& fits_;
  std::vector<StatedParameters> list_;
};

}  // namespace

std::vector<StatedParameters> with_stated_parameters(SiteFitter& fitter, const SiteHypothesis& found,
                                                     const SiteHypothesis& nominal,
                                                     const FitsOfCandidates& fits) {
  Replacement replacement(fitter, fits);
  const bool have_several_moved = found.free_parameters() > 1;
  if (found.terms.empty()) {
    replacement.try_at(nominal, {}, have_several_moved);
    return replacement.take();
  }
  SiteHypothesis stated = found;
  std::ranges::fill(stated.factors, 1.0);
  stated.is_free.assign(stated.is_free.size(), false);
  if (have_several_moved) replacement.try_at(stated, {}, true);
  for (size_t t = 0; t < found.terms.size(); ++t) {
    const SiteHypothesis rest = without(stated, t);
    replacement.try_at(rest, t, true);
    if (found.terms[t].variable >= 0) replacement.try_with_constant(rest, t, found.terms[t].site);
  }
  return replacement.take();
}

}  // namespace loopwright::diagnosis
