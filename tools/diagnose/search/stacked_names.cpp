#include "tools/diagnose/search/stacked_names.h"
#include <algorithm>
#include <cmath>
#include <set>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/site_ranking.h"
#include "tools/diagnose/search/site_size.h"
#include "tools/diagnose/search/state_behind.h"

namespace loopwright::diagnosis {
namespace {

/// A period that repeats less often within the range of its signal is no pattern yet.
constexpr double fewest_repeats = 3;
constexpr int steps_of_refining = 4;

enum class LawOfFriction { dry, viscous, drag, none };
LawOfFriction law_of(const TermShape& shape) {
  using enum LawOfFriction;
  if (is_dry_friction(shape) || shape.name == "soft_sign") return dry;
  if (shape.name == "linear") return viscous;
  return shape.name == "signed_square" || shape.name == "cube" ? drag : none;
}

}  // namespace

std::vector<StackedNames> stacked_names(SiteFitter& fitter, const SiteHypothesis& at, size_t fewest) {
  std::vector<StackedNames> list;
  SitePass pass;
  SiteHypothesis along = at;
  if (at.terms.size() < fewest || !fitter.pass(along, true, pass)) return list;
  const std::vector<int> behind = states_behind(fitter.model(), pass);
  for (size_t t = 0; t < at.terms.size(); ++t) {
    const SiteTerm& term = at.terms[t];
    if (term.variable < 0 || term.shape->of == TermShape::Of::own || is_unknown_function(*term.shape))
      continue;
    const int variable = behind[size_t(term.variable)];
    auto same = std::ranges::find_if(
        list, [&](const StackedNames& s) { return s.site == term.site && s.variable == variable; });
    if (same == list.end()) same = list.insert(same, {term.site, variable, {}});
    same->terms.push_back(t);
  }
  for (StackedNames& names : list) {  // a single name keeps its own variable
    const int own = at.terms[names.terms.front()].variable;
    if (std::ranges::all_of(names.terms, [&](size_t t) { return at.terms[t].variable == own; }))
      names.variable = own;
  }
  std::erase_if(list, [&](const StackedNames& s) { return s.terms.size() < fewest; });
  return list;
}

SiteHypothesis without(const SiteHypothesis& at, const StackedNames& names) {
  SiteHypothesis rest = at;
  for (size_t i = names.terms.size(); i-- > 0;)
    rest.terms.erase(rest.terms.begin() + std::ptrdiff_t(names.terms[i]));
  return rest;
}

bool are_usual_together(const SiteHypothesis& at, const StackedNames& names) {
  std::set<LawOfFriction> laws;
  const bool are_of_friction = std::ranges::all_of(names.terms, [&](size_t t) {
    const LawOfFriction law = law_of(*at.terms[t].shape);
    return at.terms[t].variable == names.variable && law != LawOfFriction::none && laws.insert(law).second;
  });
  std::set<std::string_view> shapes;
  return are_of_friction || std::ranges::all_of(names.terms, [&](size_t t) {
           const std::string_view shape = at.terms[t].shape->name;
           return (shape == "radiation" || shape == "convection" || shape == "linear") &&
                  shapes.insert(shape).second;
         });
}

bool cancel(SiteFitter& fitter, SiteHypothesis at, const StackedNames& names) {
  SitePass pass;
  if (names.terms.size() < 2 || !fitter.pass(at, true, pass)) return false;
  const std::vector<SiteVariable>& variables = fitter.model().variables();
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(Eigen::Index(pass.rows)), value = sum;
  double largest = 0;
  for (const size_t t : names.terms) {
    const SiteTerm& term = at.terms[t];
    if (term.shape->remembered) continue;
    for (size_t k = 0; k < pass.rows; ++k)
      value[Eigen::Index(k)] =
          term.value(variables[size_t(term.variable)].at(&pass.path[0][k * pass.numbers]));
    value.array() -= value.mean();  // heat that is in proportion to kelvins cancels a constant
    largest = std::max(largest, value.norm());
    sum += value;
  }
  return largest > criteria::most_cancelling * sum.norm();
}

bool are_periods(const SiteHypothesis& at, const StackedNames& names, double range) {
  return std::ranges::all_of(names.terms, [&](size_t t) {
    const SiteTerm& term = at.terms[t];
    return term.shape->name == "periodic" && fewest_repeats * term.nonlinear[0] < range;
  });
}

bool explains_as_much(SiteFitter& fitter, const SiteHypothesis& at, const StackedNames& names,
                      const SiteHypothesis& function) {
  const auto& range = function.terms.back().nonlinear;
  const bool are_usual = are_usual_together(at, names) && !cancel(fitter, at, names);
  if (names.terms.size() < 2 || are_usual || are_periods(at, names, range[1] - range[0])) return false;
  SiteHypothesis nothing = without(at, names);
  fitter.refine(nothing, 6);
  fitter.fit_noise(nothing);
  const double gained = nothing.objective - at.objective;
  return nothing.objective - function.objective > criteria::least_share_of_function * gained;
}

bool is_detail_of_named_law(SiteFitter& fitter, SiteHypothesis h) {
  SitePass pass;
  if (!fitter.pass(h, true, pass)) return false;
  const SiteModel& model = fitter.model();
  const SiteTerm function = h.terms.back();
  const double size = size_of_term(model, pass, function);
  return std::any_of(h.terms.begin(), h.terms.end() - 1, [&](const SiteTerm& law) {
    return law.site == function.site && law.variable == function.variable &&
           size < criteria::least_share_of_law * size_of_term(model, pass, law);
  });
}

std::optional<size_t> add_constant_to_function(SiteHypothesis& at) {
  for (size_t t = 0; t < at.terms.size(); ++t) {
    const SiteTerm& constant = at.terms[t];
    if (constant.shape->of != TermShape::Of::nothing) continue;
    const auto function = std::ranges::find_if(at.terms, [&](const SiteTerm& other) {
      return other.site == constant.site && is_unknown_function(*other.shape);
    });
    if (function == at.terms.end()) continue;
    for (int c = 0; c < function->shape->columns; ++c)
      function->coefficient[size_t(c)] += constant.coefficient[0];
    at = without(std::move(at), t);
    return t;
  }
  return {};
}

std::optional<SiteHypothesis> with_function(SiteFitter& fitter, const SiteHypothesis& at,
                                            const StackedNames& names,
                                            const std::function<double(const SiteHypothesis&)>& criterion) {
  const SiteHypothesis rest = without(at, names);
  std::optional<SiteHypothesis> best;
  for (const SiteCandidate& candidate :
       rank_terms_at(fitter, rest, unknown_functions(), names.site, names.variable)) {
    SiteHypothesis trial = rest;
    trial.terms.push_back(candidate.term);
    while (add_constant_to_function(trial)) {
    }
    fitter.refine(trial, steps_of_refining);
    fitter.fit_noise(trial);
    fitter.refine(trial, steps_of_refining);
    if (!std::isfinite(trial.objective)) continue;
    if (best && criterion(*best) <= criterion(trial)) break;  // finer ones cost more still
    best = std::move(trial);
  }
  return best;
}

}  // namespace loopwright::diagnosis
