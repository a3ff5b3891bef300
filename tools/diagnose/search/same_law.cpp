#include "tools/diagnose/search/same_law.h"
#include <algorithm>
#include <cmath>
#include <limits>
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

SiteTerm offset_of_sensor(SiteFitter& fitter, int site, const SiteNoise& noise) {
  const int output = fitter.model().output_of_sensor(site);
  return plain_term(fitter, "constant", site, -1, noise.measurement[size_t(output)]);
}

bool has_term_at(const SiteHypothesis& h, int site) {
  return std::ranges::find(h.terms, site, &SiteTerm::site) != h.terms.end();
}

/// Of each sensor that the search does not look at, and that has no error yet: an offset, another scale, and
/// both.
std::vector<std::vector<SiteTerm>> errors_of_sensors(SiteFitter& fitter, const SiteHypothesis& at) {
  constexpr double notable_error_of_scale = 0.01;  // of what is measured
  const SiteModel& model = fitter.model();
  std::vector<std::vector<SiteTerm>> list;
  for (int site = 0; site < int(model.sites().size()); ++site) {
    if (!model.sites()[size_t(site)].is_sensor_not_looked_at() || has_term_at(at, site)) continue;
    const SiteTerm offset = offset_of_sensor(fitter, site, at.noise),
                   scale =
                       plain_term(fitter, "linear", site, model.own_variable(site), notable_error_of_scale);
    list.push_back({offset}), list.push_back({scale}), list.push_back({offset, scale});
  }
  return list;
}

/// Leaves out an offset and another scale together, where one of them explains nearly as much.
void leave_out_idle_second_terms(std::vector<SiteHypothesis>& list, double least_gain) {
  const std::vector<SiteHypothesis> all = list;
  std::erase_if(list, [&](const SiteHypothesis& both) {
    return std::ranges::any_of(all, [&](const SiteHypothesis& one) {
      return one.terms.size() < both.terms.size() && one.terms.back().site == both.terms.back().site &&
             one.objective - both.objective < least_gain;
    });
  });
}

/// A hypothesis with an error of each sensor; those that come near what was found.
std::vector<SiteHypothesis> near_with_error_of_sensor(SiteFitter& fitter, const SiteHypothesis& found,
                                                      const SiteHypothesis& at) {
  constexpr int steps_with_more_noise = 4, steps_beside_noise_found = 2;
  std::vector<SiteHypothesis> list;
  SiteHypothesis bare = at;
  bare.noise = found.noise;  // with which an error that explains as much shows it
  SitePass pass;
  const double lacking = fitter.pass(bare, false, pass) ? bare.scaled_objective - found.scaled_objective
                                                        : std::numeric_limits<double>::infinity();
  const double most_behind = std::max(criteria::least_behind, criteria::behind_after_all_steps * lacking);
  for (const std::vector<SiteTerm>& error : errors_of_sensors(fitter, at)) {
    if (fitter.is_interrupted() || fitter.model().work().is_spent(criteria::work_with_rivals)) break;
    SiteHypothesis with = at;
    with.terms.insert(with.terms.end(), error.begin(), error.end());
    fitter.refine(with, steps_with_more_noise);  // with more noise no error is too large to begin with
    with.noise = found.noise;
    fitter.refine(with, steps_beside_noise_found);
    if (with.scaled_objective < found.scaled_objective + most_behind) list.push_back(std::move(with));
  }
  return list;
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
      if (!model.sites()[site].is_sensor_not_looked_at() || has_term_at(at, int(site))) continue;
      SiteHypothesis other = without(at, t);
      std::ranges::fill(other.factors, 1.0);
      other.is_free.assign(other.is_free.size(), false);
      other.terms.push_back(offset_of_sensor(fitter, int(site), other.noise));
      fit(fitter, other);
      if (std::isfinite(other.objective)) list.push_back({std::move(other), t});
    }
  }
  return list;
}

std::vector<SiteHypothesis> with_error_of_one_sensor(SiteFitter& fitter, const SiteHypothesis& found,
                                                     std::span<const SiteHypothesis> hypotheses,
                                                     double least_gain) {
  constexpr int further_steps = 3;
  constexpr size_t most_of_each = 3;  // an offset, another scale, and both, of the same sensor
  std::vector<SiteHypothesis> list;
  for (const SiteHypothesis& at : hypotheses) {
    std::vector<SiteHypothesis> near = near_with_error_of_sensor(fitter, found, at);
    std::ranges::stable_sort(near, {}, &SiteHypothesis::scaled_objective);
    near.resize(std::min(most_of_each, near.size()));
    for (SiteHypothesis& with : near) {
      fitter.anneal(with);
      fitter.refine(with, further_steps);
    }
    leave_out_idle_second_terms(near, least_gain);
    std::ranges::move(near, std::back_inserter(list));
  }
  return list;
}

}  // namespace loopwright::diagnosis
