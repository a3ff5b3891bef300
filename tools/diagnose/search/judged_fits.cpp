#include "tools/diagnose/search/judged_fits.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/moved_parameters.h"
#include "tools/diagnose/search/site_screening.h"
#include "tools/diagnose/search/stacked_names.h"

namespace loopwright::diagnosis {
namespace {

constexpr size_t fitted_keys = 5, fitted_pairs = 2;  // candidates that are confirmed by real fits
/// [of the gain needed, and of the best candidate's] A smaller linearized gain is not worth a real fit.
constexpr double promising = 0.4, promising_beside_best = 0.2;

}  // namespace

double JudgedFits::gain_needed() const {
  return std::max(criteria::least_gain_of_term, criteria::least_gain_of_term_per_reading * readings_);
}

double JudgedFits::whole_criterion(const SiteHypothesis& h) {
  return criterion(h) + cost_of_parameter * double(h.free_parameters());
}

void JudgedFits::tell(const std::string& what, const SiteHypothesis& at) {
  std::string noise;
  for (double s : at.noise.process) noise += fmt::format(" {:.3g}", s);
  noise += " |";
  for (double r : at.noise.measurement) noise += fmt::format(" {:.3g}", r);
  for (const SlowNoise& slow : at.noise.slow)
    noise += fmt::format(" | slow {:.3g} {:.3g} s", slow.size, slow.time);
  result_.trail.push_back(fmt::format("{}: -2 ln L {:.1f}, criterion {:.1f}, noise{}, after {}", what,
                                      at.objective, criterion(at), noise,
                                      told_operations(model().work().done())));
}

double JudgedFits::criterion(const SiteHypothesis& h) {
  double sum = h.objective + double(size_of(h)) * std::log(readings_);
  for (const SiteTerm& term : h.terms) sum += 2 * cost_of(model(), term) + 2 * std::log(double(keys_));
  return sum;
}

std::vector<SiteHypothesis> JudgedFits::fits(const SiteHypothesis& at,
                                             std::span<const SiteCandidate> candidates) {
  std::vector<SiteHypothesis> list;
  double most = 0;
  for (const SiteCandidate& candidate : candidates) most = std::max(most, candidate.gain);
  for (const SiteCandidate& candidate : candidates) {
    if (candidate.gain < std::max(promising * gain_needed(), promising_beside_best * most)) continue;
    SiteHypothesis trial = at;
    if (candidate.constant) trial.terms.push_back(*candidate.constant);
    trial.terms.push_back(candidate.term);
    if (candidate.term.shape->of == TermShape::Of::own) trial.terms.back().coefficient[0] = 1;
    list.push_back(std::move(trial));
  }
  const auto refine = [&](int steps) {
    fitter_.side_by_side(list.size(), [&](SiteFitter& fitter, size_t i) { fitter.refine(list[i], steps); });
  };
  refine(first_steps);
  std::erase_if(list, [](const SiteHypothesis& h) { return !std::isfinite(h.objective); });
  keep_best(list, at, criteria::behind_after_first_steps);
  refine(further_steps);
  keep_best(list, at, criteria::behind_after_all_steps);
  fitter_.side_by_side(list.size(), [&](SiteFitter& fitter, size_t i) {
    fitter.fit_noise(list[i]);
    fitter.refine(list[i], last_steps);
  });
  std::ranges::sort(list, {}, [&](const SiteHypothesis& h) { return criterion(h); });
  return list;
}
std::vector<SiteCandidate> JudgedFits::candidates(const SiteHypothesis& at) {
  std::vector<SiteCandidate> ranked = rank_terms(fitter_, at, fitter_.shapes(), true), pairs;
  std::ranges::copy_if(ranked, std::back_inserter(pairs), [](const auto& c) { return bool(c.constant); });
  std::erase_if(ranked, [](const auto& c) { return bool(c.constant); });
  keys_ = std::max<size_t>(keys_, ranked.size());
  leave_out_twins(ranked), leave_out_twins(pairs);
  pairs.resize(std::min(fitted_pairs, pairs.size()));
  std::vector<SiteCandidate> list = worth_fitting(ranked, fitted_keys);
  for (const SiteCandidate& c : list)
    result_.trail.push_back(
        fmt::format("  ranked {}: {:.1f}, cost {:.1f}", describe(model(), c.term), c.gain, c.cost));
  std::ranges::copy(pairs, std::back_inserter(list));
  return list;
}

void JudgedFits::forget_rivals_of(size_t term) {
  std::erase_if(result_.rivals, [&](const SiteRival& r) { return r.of == term; });
  for (SiteRival& r : result_.rivals) r.of -= r.of > term;
}

bool JudgedFits::remove_idle(SiteHypothesis& at) {
  bool is_any_removed = false;
  for (size_t t = at.terms.size(); t-- > 0;) {
    SiteHypothesis rest = without(at, t);
    fitter_.refine(rest, first_steps);
    if (rest.scaled_objective - at.scaled_objective >= criteria::far_from_idle * gain_needed()) continue;
    fitter_.refine(rest, further_steps + 1);
    fitter_.fit_noise(rest);
    if (rest.objective - at.objective >= gain_needed()) continue;
    tell("- " + describe(model(), at.terms[t]), rest);
    forget_rivals_of(t);
    at = std::move(rest), is_any_removed = true;
  }
  return is_any_removed;
}

bool JudgedFits::leave_out_detail(SiteHypothesis& at) {
  if (at.terms.empty() || !is_unknown_function(*at.terms.back().shape) ||
      !is_detail_of_named_law(fitter_, at))
    return false;
  at.terms.pop_back();
  forget_rivals_of(at.terms.size());
  fitter_.refine(at, further_steps + 1);
  fitter_.fit_noise(at);
  tell("without the function, a detail of its law", at);
  return true;
}

}  // namespace loopwright::diagnosis
