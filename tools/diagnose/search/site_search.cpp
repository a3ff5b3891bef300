#include "tools/diagnose/search/site_search.h"
#include <algorithm>
#include <cmath>
#include <utility>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/beyond_start.h"
#include "tools/diagnose/search/function_in_names.h"
#include "tools/diagnose/search/late_input.h"
#include "tools/diagnose/search/moved_parameters.h"
#include "tools/diagnose/search/one_parameter.h"
#include "tools/diagnose/search/same_law.h"
#include "tools/diagnose/search/simpler_answers.h"
#include "tools/diagnose/search/simpler_friction.h"
#include "tools/diagnose/search/site_disturbance.h"
#include "tools/diagnose/search/site_screening.h"
#include "tools/diagnose/search/site_start.h"
#include "tools/diagnose/search/stacked_names.h"
#include "tools/diagnose/search/stated_parameters.h"

namespace loopwright::diagnosis {
namespace {

constexpr int most_changes = 3;  // of an answer whose parameters are decided
using criteria::least_gain_of_unknown, criteria::least_gain_of_unknown_per_reading;
using criteria::least_improvement, criteria::least_exchange, criteria::rival_within, criteria::most_terms;

class SiteSearch : SimplerAnswers {
 public:
  SiteSearch(SiteFitter& fitter, const std::function<void(const char*, double)>& progress, ErrorsOf errors,
             const std::vector<SlowNoise>& disturbances)
      : SimplerAnswers(fitter), progress_(progress), errors_(errors), disturbances_(disturbances) {}

  std::optional<SiteSearchResult> run() {
    SiteHypothesis& nominal = result_.nominal;
    const std::optional<double> readings = start_from_stated(fitter_, errors_, disturbances_, nominal);
    if (!readings) return {};
    readings_ = *readings;
    tell("the diagram as it is", nominal);
    progress_("fitting parameters", 0.1);
    result_.parameters = with_free_parameters(fitter_, nominal);
    tell("parameters free", result_.parameters);
    if (disturbances_.empty()) single_ = with_one_parameter(fitter_, nominal, result_.parameters);
    std::optional<SiteHypothesis> alone = explained_by_late_input(fitter_, nominal, result_.parameters);
    if (alone) tell("a late input by itself", *alone);
    if (!alone && is_explained_by_one_parameter()) tell("a parameter by itself", *(alone = single_.front()));
    if (!alone && errors_ == ErrorsOf::predictions && disturbances_.empty())
      begin_beside_small_disturbances();
    // What is missing bends parameters that are free, and each costs runs of the model: they come second.
    SiteSearchResult first = searched_from(alone.value_or(nominal), 0.2);
    if (!is_doubtful(first.found) || is_spent(criteria::work_of_first_search)) return first;
    result_.trail = std::move(first.trail);
    result_.trail.push_back(alone ? "again, from stated parameters" : "again, from free parameters");
    SiteSearchResult second = searched_from(alone ? nominal : result_.parameters, 0.6);
    // Terms may stand for parameters: only clearly better ones take the place of what free parameters leave,
    // unless that has even more of them.
    const bool has_more_terms = second.found.terms.size() > first.found.terms.size();
    const double needed = alone ? least_improvement : has_more_terms ? 0 : -least_improvement;
    const bool is_better = whole_criterion(second.found) < whole_criterion(first.found) - needed;
    second.trail.push_back(is_better ? "the second is better" : "the first is better");
    if (!is_better) first.trail = std::move(second.trail);
    return is_better ? std::move(second) : std::move(first);
  }

 private:
  bool is_explained_by_one_parameter() {
    return !single_.empty() && !leaves_something(single_.front()) &&
           whole_criterion(single_.front()) < whole_criterion(result_.parameters);
  }
  /// A small disturbance that explains all there is would otherwise cost a long search that follows it by
  /// terms. Unless a single term explains all there is, and more.
  void begin_beside_small_disturbances() {
    if (!leaves_something(result_.parameters)) return;
    SiteHypothesis disturbed =
        with_disturbances(fitter_, result_.parameters, criteria::most_first_disturbances);
    if (disturbed.noise.slow.empty() || !is_explained_by_small_disturbances(fitter_, disturbed)) return;
    for (const SiteHypothesis& at : {result_.parameters, result_.nominal}) {
      const std::vector<SiteHypothesis> tried = fits(at, candidates(at));
      if (!tried.empty() && tried.front().objective < disturbed.objective && !leaves_something(tried.front()))
        return;
    }
    result_.nominal.noise.slow = disturbed.noise.slow;
    fitter_.fit_noise(result_.nominal);
    result_.parameters = std::move(disturbed);
    tell("beside a slow disturbance", result_.parameters);
  }
  /// Terms are added with the parameters of this hypothesis, which may be free.
  SiteSearchResult searched_from(SiteHypothesis at, double progress) {
    SiteSearchResult before = result_;
    begin_ = progress;
    add_terms(at);
    if (name_function(at)) add_terms(at);
    std::optional<SiteHypothesis> stated;
    if (at.free_parameters() == 0) {
      stated = at;
      at = with_free_parameters(fitter_, std::move(at));
      tell("parameters free beside the terms", at);
      add_terms(at);
    }
    exchange(at);
    for (const size_t t : simplify_friction(fitter_, at, [&](const auto& h) { return criterion(h); }))
      tell("simpler: " + describe(model(), at.terms[t]), at);
    if (leaves_something(at)) merge_stacked_names(at, 1);
    add_unknown(at);
    remove_idle(at);
    progress_("deciding which parameters moved", begin_ + 0.3);
    decide_parameters(at);
    exchange_again(at);
    if (stated && whole_criterion(*stated) < whole_criterion(at) - least_exchange) {
      at = *stated;
      tell("as it was before parameters were free", at);
      result_.rivals.clear(), result_.parameter_rivals.clear(), exchanged_beside_.clear();
    }
    if (remove_idle(at)) decide_parameters(at);
    if (leave_out_detail(at)) decide_parameters(at);
    for (int left = most_changes;; --left) {
      join_terms(at, [&](SiteHypothesis& h) { decide_again(h); });
      compare_levels(at);
      compare_with_parameters_of_same_response(at);
      compare_with_stated_parameters(at);
      declare_offsets_of_sensors(at);
      compare_with_one_parameter(at);
      compare_with_sensors(at);
      if (left == 0 || !(exchange_again(at) || (name_function(at) && decide_again(at)))) break;
    }
    if (errors_ == ErrorsOf::predictions) at = without_idle_disturbances(fitter_, std::move(at));
    result_.found = std::move(at);
    return std::exchange(result_, std::move(before));
  }
  /// A strong term bends the parameters that are fitted without it, and other terms then mend that. Such an
  /// answer has several terms, or moved parameters beside terms, or leaves something.
  bool is_doubtful(const SiteHypothesis& found) {
    if (found.terms.size() + found.free_parameters() > 1) return true;
    if (!found.terms.empty() && is_unknown_function(*found.terms.front().shape)) return true;
    return leaves_something(found);
  }
  bool leaves_something(const SiteHypothesis& h) { return !leaves_white_errors(fitter_, h); }
  void add_terms(SiteHypothesis& at) {
    while (at.terms.size() < most_terms && !is_spent(criteria::work_of_search)) {
      progress_("searching", begin_ + 0.05 * double(at.terms.size()));
      std::vector<SiteHypothesis> tried = fits(at, candidates(at));
      if (tried.empty()) return;
      SiteHypothesis best = std::move(tried.front());
      const bool gains = is_worth_adding(best, at);
      tell((gains ? "+ " : "not enough: ") + describe(model(), best.terms.back()), best);
      if (!gains) return;
      fitter_.anneal(best);
      tell("  annealed", best);
      at = std::move(best);
      remove_idle(at);
      merge_stacked_names(at, 2);
      result_.steps.push_back(at);
    }
  }

  /// The start of the record by itself is no reason for a term.
  bool is_worth_adding(const SiteHypothesis& with, const SiteHypothesis& at) {
    const double price = criterion(with) - with.objective - (criterion(at) - at.objective);
    const double gain = std::min(at.objective - with.objective,
                                 objective_beyond_start(fitter_, at) - objective_beyond_start(fitter_, with));
    return gain >= gain_needed() && gain - price >= least_improvement;
  }

  /// Names that pile up at one site for one signal may stand for a function without a name.
  void merge_stacked_names(SiteHypothesis& at, size_t fewest) {
    for (const StackedNames& names : stacked_names(fitter_, at, fewest)) {
      if (fewest > 1 && are_usual_together(at, names) && !cancel(fitter_, at, names)) continue;
      const auto judged = [&](const auto& h) { return criterion(h); };
      const auto function = with_function(fitter_, at, names, judged);
      if (!function) continue;
      tell("in the place of " + std::to_string(names.terms.size()) +
               " names: " + describe(model(), function->terms.back()),
           *function);
      const double needed = std::max(least_gain_of_unknown, least_gain_of_unknown_per_reading * readings_);
      const bool is_better = judged(*function) < judged(at) - needed;
      if (!is_better && !explains_as_much(fitter_, at, names, *function)) continue;
      at = *function;
      result_.rivals.clear();
      return merge_stacked_names(at, fewest);
    }
  }
  /// In the criterion: a worse term is no rival.
  double most_of_rival() const {
    return std::max(rival_within, criteria::least_gain_of_term_per_reading * readings_);
  }

  /// Each term is replaced by the best other one in its place.
  void exchange(SiteHypothesis& at) {
    exchanged_beside_ = at.is_free;
    for (size_t t = 0; t < at.terms.size() && !is_spent(criteria::work_with_rivals); ++t) {
      const SiteTerm term = at.terms[t];
      const SiteHypothesis rest = without(at, t);
      std::vector<SiteCandidate> others = rank_terms(fitter_, rest, fitter_.shapes());
      leave_out_hopeless(others, term);
      for (SiteHypothesis& other : fits(rest, worth_fitting(others, 3))) {
        const double needed = size_of(other) > size_of(at) ? 20 : least_exchange;
        const double worse = criterion(other) - criterion(at);
        if (worse < -needed) {
          tell("exchanged for " + describe(model(), other.terms.back()), other);
          result_.rivals.push_back({t, at.terms[t], 0});
          for (SiteRival& rival : result_.rivals) rival.worse -= worse;
          std::erase_if(result_.rivals, [&](const SiteRival& r) { return r.worse >= most_of_rival(); });
          at = other;
          std::rotate(at.terms.begin() + std::ptrdiff_t(t), at.terms.end() - 1, at.terms.end());
        } else if (worse < most_of_rival()) {
          result_.rivals.push_back({t, other.terms.back(), worse});
        }
      }
    }
  }

  /// Parameters that are free hide how terms differ: they are compared once more beside those that are
  /// decided. Whether another one does better.
  bool exchange_again(SiteHypothesis& at) {
    if (at.terms.empty() || at.is_free == exchanged_beside_ || is_spent(criteria::work_with_rivals))
      return false;
    std::vector<SiteRival> known = std::exchange(result_.rivals, {});
    const double before = criterion(at);
    exchange(at);
    if (criterion(at) < before) return decide_again(at);
    if (is_spent(criteria::work_with_rivals)) result_.rivals = std::move(known);  // not all were asked
    return false;
  }

  /// Puts two names in the place of a function without one, where they explain more with fewer numbers. Names
  /// that explain less are no reason: sums of laws resemble any function. A single name is judged as in
  /// exchange().
  bool name_function(SiteHypothesis& at) {
    if (at.terms.size() >= most_terms || is_spent(criteria::work_with_rivals)) return false;
    const double before = criterion(at);
    const size_t terms = at.terms.size();
    const auto fit = [&](const auto& h, auto list) { return fits(h, list); };
    for (const SiteHypothesis& named : function_in_names(fitter_, at, fit)) {
      tell("in the place of the function: " + describe(model(), named.terms.back()), named);
      const bool is_one = named.terms.size() == terms;
      if ((is_one || named.objective < at.objective) && criterion(named) < criterion(at) - least_exchange)
        take(at, named, "names do better");
    }
    return criterion(at) < before;
  }
  bool decide_again(SiteHypothesis& at) {
    result_.parameter_rivals.clear(), remove_idle(at), decide_parameters(at);
    return true;
  }

  void add_unknown(SiteHypothesis& at) {
    if (is_spent(criteria::work_with_rivals)) return;
    const std::vector<SiteCandidate> ranked = rank_terms(fitter_, at, unknown_functions().first(1));
    const auto tried = fits(at, std::span(ranked).first(std::min<size_t>(2, ranked.size())));
    if (tried.empty()) return;
    const double needed = std::max(criteria::least_gain_of_term + least_gain_of_unknown,
                                   least_gain_of_unknown_per_reading * readings_);
    tell("best unknown: " + describe(model(), tried.front().terms.back()), tried.front());
    if (at.objective - tried.front().objective < needed ||
        criterion(at) - criterion(tried.front()) < least_improvement ||
        is_detail_of_named_law(fitter_, tried.front()))
      return;
    at = tried.front();
    while (const std::optional<size_t> constant = add_constant_to_function(at)) forget_rivals_of(*constant);
    result_.steps.push_back(at);
  }

  void decide_parameters(SiteHypothesis& at) {
    std::vector<MovedParameters> choices = moved_parameters(fitter_, at, readings_);
    if (choices.empty()) return;
    at = choices.front().hypothesis;
    tell("parameters decided", at);
    result_.parameter_rivals.clear();
    for (size_t i = 1; i < choices.size(); ++i)
      if (const double worse = choices[i].criterion - choices.front().criterion; worse < rival_within)
        result_.parameter_rivals.push_back({choices[i].moved(), {}, worse});
  }

  /// A level at the edge of the record is a name for a constant and a proportion.
  void compare_levels(SiteHypothesis& at) {
    for (size_t t = 0; t < at.terms.size() && !is_spent(criteria::work_with_rivals); ++t) {
      const std::optional<SiteHypothesis> other = with_constant_and_proportion(fitter_, at, t);
      if (!other) continue;
      tell("a constant and a proportion in the place of " + describe(model(), at.terms[t]), *other);
      const double worse = criterion(*other) - criterion(at);
      const bool is_as_good = is_at_edge(at.terms[t]) && other->objective - at.objective < rival_within;
      if (is_as_good || worse < -least_exchange) {
        take(at, *other, "the level is none");
        if (at.free_parameters() > 0) decide_parameters(at);
        return compare_levels(at);
      }
      if (worse < most_of_rival())
        result_.parameter_rivals.push_back(
            {{}, {*(other->terms.end() - 2), other->terms.back()}, worse, t, false, true});
    }
  }

  /// What explains nearly as much with all parameters as stated. Where one of these explains more, terms were
  /// added beside parameters that the missing law had bent: it is the answer.
  void compare_with_stated_parameters(SiteHypothesis& at) {
    if (at.free_parameters() == 0 || is_spent(criteria::work_with_rivals)) return;
    std::optional<SiteHypothesis> better;
    const auto fit = [&](const auto& h, auto list) { return fits(h, list); };
    for (StatedParameters& other : with_stated_parameters(fitter_, at, result_.nominal, fit)) {
      const double worse = criterion(other.hypothesis) - whole_criterion(at),
                   lost = other.hypothesis.objective - at.objective;
      tell("in the place of parameters: " + describe(model(), other.terms().back()), other.hypothesis);
      const size_t numbers = size_of(other.hypothesis);
      const double most_lost = numbers < size_of(at) ? criteria::most_lost_by_fewer_changes : rival_within;
      const bool is_of_several = other.of || at.free_parameters() > 1;
      if (worse < -least_exchange && (!better || criterion(other.hypothesis) < criterion(*better)))
        better = other.hypothesis;
      if (worse < rival_within || (is_of_several && numbers <= size_of(at) && lost < most_lost))
        result_.parameter_rivals.push_back({{}, other.terms(), worse, other.of});
    }
    if (!better) return;
    take(at, *better, "it is better than parameters that moved");
    exchange(at);
    decide_parameters(at = with_free_parameters(fitter_, at));
  }

  const std::function<void(const char*, double)>& progress_;
  double begin_ = 0.2;
  const ErrorsOf errors_;
  const std::vector<SlowNoise> disturbances_;
};

}  // namespace

std::optional<SiteSearchResult> search_sites(SiteFitter& fitter,
                                             const std::function<void(const char*, double)>& progress,
                                             ErrorsOf errors, const std::vector<SlowNoise>& disturbances) {
  return SiteSearch(fitter, progress, errors, disturbances).run();
}

}  // namespace loopwright::diagnosis
