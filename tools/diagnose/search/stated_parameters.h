/// Answers with fewer changes than one in which parameters moved: all as the diagram states them, and another
/// term.
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <vector>
#include "tools/diagnose/search/site_ranking.h"

namespace loopwright::diagnosis {

struct StatedParameters {
  SiteHypothesis hypothesis;  ///< its last terms are the other ones
  std::optional<size_t> of;   ///< the term that they replace together with the parameters
  size_t added = 1;           ///< terms

  std::vector<SiteTerm> terms() const {
    return {hypothesis.terms.end() - std::ptrdiff_t(added), hypothesis.terms.end()};
  }
};

using FitsOfCandidates =
    std::function<std::vector<SiteHypothesis>(const SiteHypothesis&, std::span<const SiteCandidate>)>;

/// A law that is a little wrong bends parameters, and a bent parameter makes room for a wrong law. Each term
/// is therefore replaced together with all parameters that moved, by one or by a constant and one; where
/// there is no term, or several parameters moved, one stands for the parameters alone. `nominal` has the
/// noise of the diagram as it is.
std::vector<StatedParameters> with_stated_parameters(SiteFitter& fitter, const SiteHypothesis& found,
                                                     const SiteHypothesis& nominal,
                                                     const FitsOfCandidates& fits);

}  // namespace loopwright::diagnosis
