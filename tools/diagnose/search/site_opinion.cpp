#include "tools/diagnose/search/site_opinion.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/site_disturbance.h"
#include "tools/diagnose/search/site_simulation.h"
#include "tools/diagnose/search/site_size.h"

namespace loopwright::diagnosis {
namespace {

/// Sites where the noise of the answer is a large part of the signal.
std::vector<NoisySite> noisy_sites(SiteFitter& fitter, SiteHypothesis h) {
  std::vector<NoisySite> list;
  SitePass pass;
  if (!fitter.pass(h, true, pass)) return list;
  for (size_t s = 0; s < h.noise.sites.size(); ++s) {
    const int site = h.noise.sites[s];
    const double size = size_at_site(fitter.model(), pass, site);
    if (size > 0 && h.noise.process[s] > criteria::most_process_noise * size)
      list.push_back({site, h.noise.process[s] / size});
  }
  return list;
}

/// States on which no output depends directly.
std::vector<int> unmeasured_states(SiteFitter& fitter, SiteHypothesis h) {
  std::vector<int> list;
  SitePass pass;
  if (!fitter.pass(h, false, pass)) return list;
  for (int state = 0; state < fitter.model().states(); ++state) {
    bool is_seen = false;
    for (size_t at = size_t(state); at < pass.C.size(); at += pass.states) is_seen |= pass.C[at] != 0;
    if (!is_seen) list.push_back(state);
  }
  return list;
}

/// Mean of ln(rms of the one / rms of the other) over the outputs.
double log_ratio(const std::vector<double>& one, const std::vector<double>& other) {
  double sum = 0;
  for (size_t j = 0; j < one.size(); ++j) sum += std::log(one[j] / other[j]);
  return sum / double(one.size());
}

/// Both in what was fitted and in what was held out: a term may fit the slow errors of a record by chance,
/// and so may each change that it has more than the other answer.
bool is_clearly_better(const SimulationErrors& simulation, const SimulationErrors& predictions,
                       size_t more_changes) {
  const bool has_held_out = !simulation.held_out.empty();
  const double needed = std::log(has_held_out ? criteria::better_simulation_held_out
                                              : criteria::better_simulation_without_hold_out) +
                        double(more_changes) * std::log(criteria::better_simulation_per_change);
  return log_ratio(simulation.fitted, predictions.fitted) < needed &&
         (!has_held_out || log_ratio(simulation.held_out, predictions.held_out) < needed);
}

/// A simulation that misses more than one of the diagram as it is names no cause.
bool is_worse_than_stated(SiteFitter& fitter, const SimulationErrors& simulation,
                          const SiteHypothesis& nominal) {
  const auto of_nominal = simulation_errors(fitter, nominal);
  return of_nominal && log_ratio(simulation.judged(), of_nominal->judged()) > 0;
}

/// The other search agrees if it names the same, or the same and more that does not help its simulation.
void compare_names(SecondOpinion& opinion, std::vector<std::string> own) {
  std::vector<std::string> other = opinion.other;
  std::ranges::sort(other), std::ranges::sort(own);
  opinion.agrees = other == own;
  const bool is_helped = !opinion.error || (opinion.other_error && *opinion.other_error < *opinion.error);
  if (opinion.agrees || own.empty() || is_helped || !std::ranges::includes(other, own)) return;
  opinion.agrees = true;
  std::ranges::set_difference(other, own, std::back_inserter(opinion.idle));
}

/// One of two answers, with the trails of both.
SiteSearchResult one_of(SiteSearchResult first, SiteSearchResult second, bool takes_second) {
  std::vector<std::string> trail = std::move(first.trail);
  std::ranges::move(second.trail, std::back_inserter(trail));
  SiteSearchResult answer = std::move(takes_second ? second : first);
  answer.trail = std::move(trail);
  return answer;
}

/// -2 ln L with the price of every number, those of the slow noise included.
double criterion_with_noise(SiteFitter& fitter, SiteHypothesis h) {
  SitePass pass;
  if (!fitter.pass(h, false, pass)) return std::numeric_limits<double>::infinity();
  double sum = h.objective + double(size_of(h) + 2 * h.noise.slow.size()) * std::log(double(pass.readings));
  for (const SiteTerm& term : h.terms) sum += 2 * cost_of(fitter.model(), term);
  return sum;
}

/// Whether there is something that slow disturbances could explain.
bool leaves_room_for_disturbances(SiteFitter& fitter, const SiteHypothesis& h) {
  const auto is_unknown = [](const SiteTerm& term) { return is_unknown_function(*term.shape); };
  return std::ranges::any_of(h.terms, is_unknown) || !leaves_white_errors(fitter, h);
}

/// The answer with slow disturbances in the place of what has no name; nothing if they do not explain it. A
/// function that follows a disturbance is told from one of the machine by its size.
std::optional<SiteHypothesis> disturbed_instead(SiteFitter& fitter, SiteHypothesis h) {
  const size_t functions =
      std::erase_if(h.terms, [](const SiteTerm& term) { return is_unknown_function(*term.shape); });
  if (functions > 0) fitter.refine(h, 6), fitter.fit_noise(h);
  h = with_disturbances(fitter, std::move(h), criteria::most_slow_disturbances);
  const bool explain =
      functions > 0 ? is_explained_by_small_disturbances(fitter, h) : leaves_white_errors(fitter, h);
  return explain && !h.noise.slow.empty() ? std::optional(h) : std::nullopt;
}

/// Where the first answer leaves something, or has a function without a name, and slow disturbances explain
/// it, the search is made again beside them. What is found there is the answer if it is better with the price
/// of its numbers. How much of the signal such noise may be is left to the verdict.
SiteSearchResult beside_disturbances(SiteFitter& fitter, SiteSearchResult first,
                                     const std::function<void(const char*, double)>& progress) {
  if (!first.found.noise.slow.empty() || fitter.is_interrupted() ||
      !leaves_room_for_disturbances(fitter, first.found) ||
      fitter.model().work().is_spent(criteria::work_of_first_search))
    return first;
  const std::optional<SiteHypothesis> disturbed = disturbed_instead(fitter, first.found);
  if (!disturbed) return first;
  first.trail.push_back("again, beside slow disturbances");
  auto second = search_sites(fitter, progress, ErrorsOf::predictions, disturbed->noise.slow);
  if (!second || fitter.is_interrupted()) return first;
  const double before = criterion_with_noise(fitter, first.found),
               after = criterion_with_noise(fitter, second->found);
  const bool is_answer = after < before && leaves_white_errors(fitter, second->found);
  second->trail.push_back(
      fmt::format("criterion {:.1f} without slow disturbances, {:.1f} beside them", before, after));
  return one_of(std::move(first), std::move(*second), is_answer);
}

/// Whether what simulation found predicts much worse than an answer that explains all there is, with the best
/// noise of its own: it follows the motion by something else than its cause.
bool predicts_much_worse(SiteFitter& fitter, const SiteHypothesis& simulation,
                         const SiteHypothesis& predictions, std::vector<std::string>& trail) {
  if (!leaves_white_errors(fitter, predictions)) return false;
  SiteHypothesis h = simulation;
  h.noise = predictions.noise;
  fitter.anneal(h);
  const double lost = criterion_with_noise(fitter, h) - criterion_with_noise(fitter, predictions);
  trail.push_back(fmt::format("answer by simulation: predicts worse by {:.1f}", lost));
  return !(lost < criteria::most_lost_by_simulation);
}

}  // namespace

std::optional<SiteSearchResult> search_with_second_opinion(
    SiteFitter& fitter, const std::function<void(const char*, double)>& progress) {
  std::optional<SiteSearchResult> first = search_sites(fitter, progress);
  if (!first || fitter.is_interrupted()) return first;
  first = beside_disturbances(fitter, std::move(*first), progress);
  const std::vector<int> unmeasured = unmeasured_states(fitter, first->found);
  if (unmeasured.empty()) return first;
  const std::vector<NoisySite> noisy = noisy_sites(fitter, first->found);
  if (noisy.empty()) return first;
  if (fitter.model().work().is_spent(criteria::work_of_search)) {
    first->second_opinion = SecondOpinion{noisy, unmeasured};
    first->second_opinion->is_not_asked = true;
    return first;
  }
  if (leaves_white_errors(fitter, first->found) && forgets_its_start(fitter, first->found)) {
    first->trail.push_back("not again by simulation: small deviations grow along the record");
    first->second_opinion = SecondOpinion{noisy, unmeasured};
    first->second_opinion->is_lost = true;
    return first;
  }
  first->trail.push_back("again by simulation: noise in the states could explain anything");
  std::optional<SiteSearchResult> second = search_sites(fitter, progress, ErrorsOf::simulation);
  if (!second || fitter.is_interrupted()) return first;
  const auto of_first = simulation_errors(fitter, first->found),
             of_second = simulation_errors(fitter, second->found);
  const size_t changes = first->found.changes(), more = second->found.changes();
  const bool is_better =
      of_second && !is_worse_than_stated(fitter, *of_second, first->nominal) &&
      (!of_first || is_clearly_better(*of_second, *of_first, more - std::min(more, changes)));
  const bool is_answer =
      is_better && !predicts_much_worse(fitter, second->found, first->found, second->trail);
  for (const auto& [name, errors] : {std::pair{"predictions", of_first}, {"simulation", of_second}})
    second->trail.push_back(errors ? fmt::format("answer by {}: simulation misses the first output by {:.4g}",
                                                 name, errors->judged()[0])
                                   : fmt::format("answer by {} diverges in simulation", name));
  SecondOpinion opinion{noisy, unmeasured};
  opinion.is_answer = is_answer,
  opinion.other = named_in(fitter.model(), (is_answer ? first : second)->found);
  if (const auto& errors = is_answer ? of_second : of_first) opinion.error = errors->judged()[0];
  if (const auto& errors = is_answer ? of_first : of_second) opinion.other_error = errors->judged()[0];
  compare_names(opinion, named_in(fitter.model(), (is_answer ? second : first)->found));
  opinion.predicts_worse = is_better && !is_answer;
  SiteSearchResult answer = one_of(std::move(*first), std::move(*second), is_answer);
  answer.second_opinion = std::move(opinion);
  return answer;
}

}  // namespace loopwright::diagnosis
