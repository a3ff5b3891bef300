/// Several names of one signal at one site, against one function without a name.
#pragma once
#include <functional>
#include <optional>
#include <utility>
#include <vector>
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// Terms of a hypothesis that depend on one variable at one site, or on functions of it.
struct StackedNames {
  int site, variable;
  std::vector<size_t> terms;  ///< places in the hypothesis
};
/// Those with a name, distortions excluded, of sites and variables with at least `fewest` of them.
std::vector<StackedNames> stacked_names(SiteFitter& fitter, const SiteHypothesis& at, size_t fewest);

/// The hypothesis without them, not fitted again.
SiteHypothesis without(const SiteHypothesis& at, const StackedNames& names);

/// Names that occur together in machines. Other sums of laws resemble any function, as a series of sines
/// does. Laws of friction or of cooling, at most one of each kind.
bool are_usual_together(const SiteHypothesis& at, const StackedNames& names);
/// Whether one of them is much larger than what they make together: each then says nothing by itself.
bool cancel(SiteFitter& fitter, SiteHypothesis at, const StackedNames& names);
/// Whether the function explains nearly as much as names that are unusual together.
bool explains_as_much(SiteFitter& fitter, const SiteHypothesis& at, const StackedNames& names,
                      const SiteHypothesis& function);
/// Periods that each repeat often within the range of the signal.
bool are_periods(const SiteHypothesis& at, const StackedNames& names, double range);

/// Whether the last term, a function without a name, hardly changes a named law of its signal at its site: it
/// tells how exactly the law holds.
bool is_detail_of_named_law(SiteFitter& fitter, SiteHypothesis h);

/// A function without a name contains a constant of its site: it is added to the function's levels and left
/// out, which changes no error. Its place before; nothing if there is none.
std::optional<size_t> add_constant_to_function(SiteHypothesis& at);

/// The hypothesis with a function without a name in their place, of as many nodes as the criterion prefers.
/// Nothing if it cannot be fitted.
std::optional<SiteHypothesis> with_function(SiteFitter& fitter, const SiteHypothesis& at,
                                            const StackedNames& names,
                                            const std::function<double(const SiteHypothesis&)>& criterion);

}  // namespace loopwright::diagnosis
