#include "tools/diagnose/search/same_law.h"
#include <algorithm>
#include <cmath>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

const TermShape& shape_of(SiteFitter& fitter, std::string_view name) {
  const auto found = std::ranges::find(fitter.shapes(), name, &TermShape::name);
  return found == fitter.shapes().end() ? *std::ranges::find(named_shapes(), name, &TermShape::name) : *found;
}

bool is_of_level(const SiteTerm& term) {
  return term.shape->nonlinear[0] == "level" && term.shape->has_coefficients();
}

SiteTerm plain_term(SiteFitter& fitter, std::string_view shape, int site, int variable, double unit) {
  SiteTerm term;
  term.shape = &shape_of(fitter, shape), term.site = site, term.variable = variable, term.unit[0] = unit;
  return term;
}

void fit(SiteFitter& fitter, SiteHypothesis& h) {
  fitter.refine(h, 6);
  fitter.fit_noise(h);
  fitter.refine(h, 3);
}

}  // namespace

bool is_at_edge(const SiteTerm& term) {
  const double range = term.high[0] - term.low[0];
  return std::min(term.nonlinear[0] - term.low[0], term.high[0] - term.nonlinear[0]) <
         criteria::edge_of_level * range;
}

std::optional<SiteHypothesis> with_constant_and_proportion(SiteFitter& fitter, const SiteHypothesis& at,
                                                           size_t t) {
  const SiteTerm& term = at.terms[t];
  if (!is_of_level(term)) return {};
  SiteHypothesis other = without(at, t);
  // The law falls from one of them to the other, so that both begin with its slope.
  SiteTerm constant = plain_term(fitter, "constant", term.site, -1, fitter.filter().site_scale(term.site)),
           linear = plain_term(fitter, "linear", term.site, term.variable, term.unit[0]);
  constant.coefficient[0] = -term.coefficient[0] * term.nonlinear[0];
  linear.coefficient[0] = term.coefficient[0];
  other.terms.push_back(constant), other.terms.push_back(linear);
  fit(fitter, other);
  return std::isfinite(other.objective) ? std::optional(other) : std::nullopt;
}

std::vector<OffsetOfSensor> offsets_of_sensors(SiteFitter& fitter, const SiteHypothesis& at) {
  std::vector<OffsetOfSensor> list;
  const SiteModel& model = fitter.model();
  for (size_t t = 0; t < at.terms.size(); ++t) {
    if (at.terms[t].shape->of != TermShape::Of::nothing) continue;
    for (size_t site = 0; site < model.sites().size(); ++site) {
      if (model.sites()[site].kind != Site::Kind::sensor || model.sites()[site].is_searched) continue;
      SiteHypothesis other = without(at, t);
      std::ranges::fill(other.factors, 1.0);
      other.is_free.assign(other.is_free.size(), false);
      const int output = model.output_of_sensor(int(site));
      other.terms.push_back(
          plain_term(fitter, "constant", int(site), -1, other.noise.measurement[size_t(output)]));
      fit(fitter, other);
      if (std::isfinite(other.objective)) list.push_back({std::move(other), t});
    }
  }
  return list;
}

}  // namespace loopwright::diagnosis
