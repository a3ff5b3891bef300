#include "tools/diagnose/verdict/held_out_terms.h"
#include <cmath>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

/// What a term changes in the prediction errors of the held-out rows, and by how much they are smaller with
/// it, in squares of their deviations. Of a term that is there both are alike, by and large; of one that is
/// not, the second is minus the first.
struct Shown {
  double change = 0, gain = 0;
};

Shown shown_by(const SitePass& with, const std::vector<double>& without, size_t first_row) {
  Shown shown;
  for (size_t i = first_row * with.outputs; i < without.size(); ++i) {
    if (std::isnan(with.error[i])) continue;
    shown.change += squared(without[i] - with.error[i]) / with.variance[i];
    shown.gain += (squared(without[i]) - squared(with.error[i])) / with.variance[i];
  }
  return shown;
}

}  // namespace

std::vector<size_t> contradicted_terms(SiteFitter& whole, SiteHypothesis found) {
  std::vector<size_t> list;
  SitePass with;
  const SignalRecord& record = whole.model().record();
  if (record.held_out_from == record.rows() || found.terms.empty() || !whole.pass(found, false, with))
    return list;
  std::vector<double> errors(with.error.size());
  for (size_t t = 0; t < found.terms.size(); ++t) {
    std::vector<SiteTerm> others = found.terms;
    others.erase(others.begin() + std::ptrdiff_t(t));
    whole.model().use(found.factors, others);
    if (!whole.filter().run_frozen(with, errors)) continue;  // it diverges without the term
    const Shown shown = shown_by(with, errors, record.held_out_from);
    if (shown.change > criteria::least_change_of_held_out && shown.gain < 0) list.push_back(t);
  }
  return list;
}

}  // namespace loopwright::diagnosis
