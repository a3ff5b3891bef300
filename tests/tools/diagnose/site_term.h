/// A term as a search makes it.
#pragma once
#include <algorithm>
#include <string_view>
#include "tools/diagnose/predict/site_model.h"
#include "tools/diagnose/search/shape.h"

namespace loopwright {

/// A named shape of a variable, or of none, at the sum of forces.
inline diagnosis::SiteTerm term_at_net_sum(const diagnosis::SiteModel& model, std::string_view shape,
                                           std::string_view variable, double coefficient) {
  using namespace diagnosis;
  SiteTerm term;
  term.shape = &*std::ranges::find(named_shapes(), shape, &TermShape::name);
  term.site = int(std::ranges::find(model.sites(), "net.sum", &Site::name) - model.sites().begin());
  if (!variable.empty())
    term.variable =
        int(std::ranges::find(model.variables(), variable, &SiteVariable::name) - model.variables().begin());
  term.coefficient[0] = coefficient;
  return term;
}

}  // namespace loopwright
