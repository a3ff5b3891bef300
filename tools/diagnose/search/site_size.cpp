#include "tools/diagnose/search/site_size.h"
#include <algorithm>
#include <cmath>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/remembered_path.h"

namespace loopwright::diagnosis {
namespace {

/// [of its mean] By which a constant signal counts as moving.
constexpr double share_of_offset = 1e-3;

template <class Value> double root_mean_square(const SitePass& pass, Value&& value) {
  double square = 0;
  for (size_t k = 0; k < pass.rows; ++k) {
    const double v = value(&pass.path[0][k * pass.numbers]);
    square += v * v;
  }
  return std::sqrt(square / double(pass.rows));
}

}  // namespace

double size_at_site(const SiteModel& model, const SitePass& pass, int site) {
  const Site& place = model.sites()[size_t(site)];
  const bool is_sensor = place.kind == Site::Kind::sensor;
  const std::vector<Number> numbers = model.plan().find(is_sensor ? place.own_signal : place.name);
  if (numbers.size() != 1 || size_t(numbers[0]) >= pass.numbers) return 0;
  const auto signal = [&](const double* at) { return at[numbers[0]]; };
  double mean = 0;
  for (size_t k = 0; k < pass.rows; ++k) mean += signal(&pass.path[0][k * pass.numbers]) / double(pass.rows);
  // Around its mean: 20 degC are no larger than 293 K. Of a signal that stays where it is, rounding alone.
  const double spread = root_mean_square(pass, [&](const double* at) { return signal(at) - mean; });
  return std::max(spread, share_of_offset * std::abs(mean));
}

double size_of_term(const SiteModel& model, const SitePass& pass, const SiteTerm& term) {
  if (term.shape->of == TermShape::Of::past) {
    double square = 0;
    for (const InputLine& change : model.change_of_input(term)) square += change.value * change.value;
    return std::sqrt(square / double(model.record().rows()));
  }
  if (term.shape->remembered) {
    const auto along = remembered_along(model, pass, term);
    double square = 0;
    for (double memory : along[0]) square += memory * memory;
    return std::abs(term.coefficient[0]) * std::sqrt(square / double(pass.rows));
  }
  return root_mean_square(pass, [&](const double* at) {
    return term.value(term.variable < 0 ? 0 : model.variables()[size_t(term.variable)].at(at));
  });
}

std::vector<size_t> terms_that_are_something(SiteFitter& fitter, SiteHypothesis h) {
  std::vector<size_t> list;
  SitePass pass;
  const SiteModel& model = fitter.model();
  const bool is_asked = !h.terms.empty() && !h.noise.is_of_simulation && fitter.pass(h, true, pass);
  for (size_t t = 0; t < h.terms.size(); ++t)
    if (!is_asked || !(size_of_term(model, pass, h.terms[t]) <
                       criteria::least_share_of_site * size_at_site(model, pass, h.terms[t].site)))
      list.push_back(t);
  return list;
}

}  // namespace loopwright::diagnosis
