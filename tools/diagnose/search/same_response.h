/// Parameters that do in the record what terms or other parameters do.
#pragma once
#include <optional>
#include <vector>
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

struct SameResponse {
  SiteHypothesis hypothesis;  ///< fitted, with its own noise
  int parameter;              ///< that moved in it
  std::optional<size_t> of;   ///< the term in whose place; nothing: in the place of all that had moved
};

/// Each parameter among `seen` whose response resembles that of a term, with all else kept; and each that
/// resembles what all moved parameters do together, with all of them as stated and the terms kept. A fit does
/// not find these by itself: what is stated counts as known about a parameter, and nothing about a term.
std::vector<SameResponse> parameters_of_same_response(SiteFitter& fitter, const SiteHypothesis& at,
                                                      const std::vector<bool>& seen);

}  // namespace loopwright::diagnosis
