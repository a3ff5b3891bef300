/// Which single terms would explain most of the prediction errors, by linear responses.
#pragma once
#include <optional>
#include <vector>
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// A shape of a variable at a site; `term` has its best first values.
struct SiteCandidate {
  SiteTerm term;
  std::optional<SiteTerm> constant;  ///< beside the term, at its site
  double cost = 0;                   ///< nats: shape, distance between variable and site
  double gain = 0;                   ///< in -2 ln L, linearized; of distortions by a pass of the model

  bool is_same_key(const SiteTerm& other) const {
    return term.shape == other.shape && term.site == other.site && term.variable == other.variable;
  }
};

/// What a term costs in an information criterion, in nats.
double cost_of(const SiteModel& model, const SiteTerm& term);

/// Sorted, best first, one for each key. Parameters and terms of the hypothesis are projected out. A column
/// of which nearly nothing is left then is not ranked: differences of the linearization would decide.
/// `with_constants`: also plain shapes together with a constant at the same site. Each of the two alone may
/// explain less than another shape that resembles their sum.
std::vector<SiteCandidate> rank_terms(SiteFitter& fitter, SiteHypothesis hypothesis,
                                      std::span<const TermShape> shapes, bool with_constants = false);

/// The same for one variable at one site, in the order of the shapes.
std::vector<SiteCandidate> rank_terms_at(SiteFitter& fitter, SiteHypothesis hypothesis,
                                         std::span<const TermShape> shapes, int site, int variable);

}  // namespace loopwright::diagnosis
