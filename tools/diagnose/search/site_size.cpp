#include "tools/diagnose/search/site_size.h"
#include <cmath>

namespace loopwright::diagnosis {
namespace {

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
  return root_mean_square(pass, [&](const double* at) { return at[numbers[0]]; });
}

double size_of_term(const SiteModel& model, const SitePass& pass, const SiteTerm& term) {
  return root_mean_square(pass, [&](const double* at) {
    return term.value(term.variable < 0 ? 0 : model.variables()[size_t(term.variable)].at(at));
  });
}

}  // namespace loopwright::diagnosis
