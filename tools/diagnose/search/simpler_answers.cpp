#include "tools/diagnose/search/simpler_answers.h"
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <tuple>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/one_parameter.h"
#include "tools/diagnose/search/same_law.h"
#include "tools/diagnose/search/same_response.h"
#include "tools/diagnose/search/site_screening.h"

namespace loopwright::diagnosis {
namespace {

using criteria::least_exchange, criteria::rival_within;

std::tuple<const TermShape*, int, int> place_of(const SiteTerm& term) {
  return {term.shape, term.site, term.variable};
}

/// The same laws at the same sites and the same parameters, in any order.
bool are_same_changes(const SiteHypothesis& one, const SiteHypothesis& other) {
  return one.is_free == other.is_free &&
         std::ranges::is_permutation(one.terms, other.terms, {}, place_of, place_of);
}

/// In the place of all that was found.
ParameterRival as_rival(const SiteHypothesis& h, double worse) {
  return {h.moved(), h.terms, worse, {}, true};
}

}  // namespace

void SimplerAnswers::take(SiteHypothesis& at, const SiteHypothesis& other, const std::string& what) {
  at = other;
  tell(what, at);
  result_.rivals.clear(), result_.parameter_rivals.clear(), result_.steps.push_back(at);
  exchanged_beside_.clear();
}

void SimplerAnswers::compare_with_parameters_of_same_response(SiteHypothesis& at) {
  if (is_spent(criteria::work_with_rivals)) return;
  for (const SameResponse& other : parameters_of_same_response(fitter_, at, result_.parameters.is_free)) {
    const double worse = whole_criterion(other.hypothesis) - whole_criterion(at);
    tell("in the place of " + (other.of ? describe(model(), at.terms[*other.of]) : "what moved") + ": " +
             model().parameters()[size_t(other.parameter)].name,
         other.hypothesis);
    const bool is_simpler = other.of || at.free_parameters() > 1;
    if (worse < (is_simpler ? least_exchange : -least_exchange)) {
      take(at, other.hypothesis, "it does as well");
      return compare_with_parameters_of_same_response(at);
    }
    if (worse < rival_within)
      result_.parameter_rivals.push_back(
          {{other.parameter}, {}, worse, other.of, false, other.of.has_value()});
  }
}

void SimplerAnswers::declare_offsets_of_sensors(const SiteHypothesis& at) {
  if (is_spent(criteria::work_with_rivals)) return;
  for (const OffsetOfSensor& other : offsets_of_sensors(fitter_, at)) {
    const double worse = criterion(other.hypothesis) - whole_criterion(at);
    tell("in the place of " + describe(model(), at.terms[other.of]) + ": " +
             describe(model(), other.hypothesis.terms.back()),
         other.hypothesis);
    if (worse < rival_within || (size_of(other.hypothesis) <= size_of(at) &&
                                 other.hypothesis.objective - at.objective < rival_within))
      result_.parameter_rivals.push_back({{}, {other.hypothesis.terms.back()}, worse, other.of});
  }
}

void SimplerAnswers::compare_with_one_parameter(SiteHypothesis& at) {
  const size_t changes = at.changes();
  if (changes == 0) return;
  for (const SiteHypothesis& one : single_) {
    const int moved = moved_parameter(one);
    if (changes == 1 && at.is_free[size_t(moved)]) continue;
    const double worse = whole_criterion(one) - whole_criterion(at);
    if (changes > 1 && worse < -least_exchange) {
      take(at, one, "a single parameter does better");
      result_.steps.clear();
      return compare_with_one_parameter(at);
    }
    const double lost = one.objective - at.objective;
    if (worse < rival_within || (changes > 1 && lost < criteria::most_lost_by_fewer_changes))
      result_.parameter_rivals.push_back({{moved}, {}, worse, {}, true});
  }
}

void SimplerAnswers::join_terms(SiteHypothesis& at, const std::function<void(SiteHypothesis&)>& decide) {
  std::vector<std::pair<SiteTerm, ParameterRival>> joined;
  while (const std::optional<ParameterRival> two = join_any_pair(at)) {
    joined.emplace_back(at.terms.back(), *two);
    if (at.free_parameters() > 0) decide(at);
  }
  for (auto& [one, two] : joined) {
    const auto place = std::ranges::find(at.terms, place_of(one), place_of);
    if (place == at.terms.end()) continue;
    two.of = size_t(place - at.terms.begin());
    result_.parameter_rivals.push_back(std::move(two));
  }
}

std::optional<ParameterRival> SimplerAnswers::join_any_pair(SiteHypothesis& at) {
  constexpr size_t fewest = 3;  // one term in the place of two alone was tried first of all
  if (at.terms.size() < fewest || named_in(model(), at) == not_joined_) return {};
  for (size_t first = 0; first < at.terms.size(); ++first)
    for (size_t second = first + 1; second < at.terms.size(); ++second) {
      if (is_spent(criteria::work_with_rivals)) break;
      if (const auto two = join_pair(at, first, second)) return two;
    }
  not_joined_ = named_in(model(), at);
  return {};
}

std::optional<ParameterRival> SimplerAnswers::join_pair(SiteHypothesis& at, size_t first, size_t second) {
  constexpr size_t most_tried = 2;
  const SiteHypothesis rest = without(without(at, second), first);
  const std::vector<SiteCandidate> ranked = rank_terms(fitter_, rest, fitter_.shapes());
  for (const SiteHypothesis& other : fits(rest, worth_fitting(ranked, most_tried))) {
    const double worse = whole_criterion(other) - whole_criterion(at);
    tell("in the place of " + describe(model(), at.terms[first]) + " and " +
             describe(model(), at.terms[second]) + ": " + describe(model(), other.terms.back()),
         other);
    if (size_of(other) >= size_of(at) || worse >= 0 || other.objective - at.objective >= rival_within)
      continue;
    ParameterRival two{{}, {at.terms[first], at.terms[second]}, -worse};
    two.keeps_parameters = true;
    take(at, other, "one term does as well as two");
    return two;
  }
  return {};
}

void SimplerAnswers::compare_with_sensors(SiteHypothesis& at) {
  if (size_of(at) == 0 || is_spent(criteria::work_with_rivals)) return;
  if (std::vector<std::string> changes = named_in(model(), at); changes != asked_beside_) {
    std::vector<SiteHypothesis> bases = changes_alone(at);
    bases.insert(bases.begin(), result_.nominal);
    asked_beside_ = std::move(changes);
    of_sensors_ = with_error_of_one_sensor(fitter_, at, bases, gain_needed());
    for (const SiteHypothesis& other : of_sensors_)
      tell(fmt::format("in the place of all: {}", fmt::join(named_in(model(), other), " + ")), other);
  }
  const auto may_be_taken = [&](const SiteHypothesis& other) {
    const double lost = other.objective - at.objective;
    const bool is_as_good =
        size_of(other) < size_of(at) ? lost < rival_within : size_of(other) == size_of(at) && lost < 0;
    return is_as_good && !are_same_changes(other, at) &&
           whole_criterion(other) < whole_criterion(at) - least_exchange;
  };
  const SiteHypothesis* best = nullptr;
  for (const SiteHypothesis& other : of_sensors_)
    if (may_be_taken(other) && (!best || whole_criterion(other) < whole_criterion(*best))) best = &other;
  if (best && looks_everywhere()) {
    const SiteHypothesis before = at;
    take(at, *best, "a single sensor does as well");
    result_.steps.clear();
    remove_idle(at);
    asked_beside_ = named_in(model(), at);  // they stand beside this answer as well
    result_.parameter_rivals.push_back(as_rival(before, whole_criterion(before) - whole_criterion(at)));
  }
  for (const SiteHypothesis& other : of_sensors_) {
    const double worse = whole_criterion(other) - whole_criterion(at), lost = other.objective - at.objective;
    const bool is_as_good = worse < rival_within || (size_of(other) <= size_of(at) && lost < rival_within);
    if (is_as_good && !are_same_changes(other, at))
      result_.parameter_rivals.push_back(as_rival(other, worse));
  }
}

std::vector<SiteHypothesis> SimplerAnswers::changes_alone(const SiteHypothesis& at) {
  constexpr size_t fewest = 2, most = 5;  // of one, nothing would be left; of more, hardly one is right
  std::vector<SiteHypothesis> list;
  if (at.changes() < fewest || at.changes() > most) return list;
  for (const SiteTerm& term : at.terms) {
    list.push_back(result_.nominal);
    list.back().terms = {term};
  }
  for (const int i : at.moved()) {
    list.push_back(result_.nominal);
    list.back().is_free[size_t(i)] = true, list.back().factors[size_t(i)] = at.factors[size_t(i)];
  }
  return list;
}

bool SimplerAnswers::looks_everywhere() {
  return std::ranges::none_of(
      model().sites(), [](const Site& site) { return site.kind != Site::Kind::sensor && !site.is_searched; });
}

}  // namespace loopwright::diagnosis
