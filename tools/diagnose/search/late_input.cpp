#include "tools/diagnose/search/late_input.h"
#include <algorithm>
#include "tools/diagnose/search/site_ranking.h"
#include "tools/diagnose/search/site_disturbance.h"

namespace loopwright::diagnosis {
namespace {

using criteria::least_gain_over_parameters;
constexpr size_t most_tried = 2;  // a delay and a lag

/// The shapes of the past, which stand side by side in the catalogue.
std::span<const TermShape> shapes_of_the_past(std::span<const TermShape> shapes) {
  const auto is_past = [](const TermShape& shape) { return shape.of == TermShape::Of::past; };
  const auto first = std::ranges::find_if(shapes, is_past);
  return {first, std::find_if_not(first, shapes.end(), is_past)};
}

}  // namespace

std::optional<SiteHypothesis> explained_by_late_input(SiteFitter& fitter, const SiteHypothesis& nominal,
                                                      const SiteHypothesis& parameters) {
  if (leaves_white_errors(fitter, parameters)) return {};
  std::optional<SiteHypothesis> best;
  const auto candidates = rank_terms(fitter, nominal, shapes_of_the_past(fitter.shapes()));
  for (size_t i = 0; i < std::min(most_tried, candidates.size()); ++i) {
    SiteHypothesis trial = nominal;
    trial.terms.push_back(candidates[i].term);
    fitter.refine(trial, 6);
    fitter.fit_noise(trial);
    fitter.refine(trial, 3);
    if (!best || trial.objective < best->objective) best = std::move(trial);
  }
  if (!best) return {};
  fitter.anneal(*best);
  const bool is_better = best->objective < parameters.objective - least_gain_over_parameters;
  return is_better && leaves_white_errors(fitter, *best) ? best : std::nullopt;
}

}  // namespace loopwright::diagnosis
