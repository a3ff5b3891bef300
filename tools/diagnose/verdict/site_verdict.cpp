#include "tools/diagnose/verdict/site_verdict.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/site_disturbance.h"
#include "tools/diagnose/search/site_size.h"
#include "tools/diagnose/search/stacked_names.h"
#include "tools/diagnose/verdict/sensors_not_looked_at.h"
#include "tools/diagnose/verdict/site_opinion_text.h"
#include "tools/diagnose/wording.h"
#include "tools/diagnose/verdict/alike_sites.h"
#include "tools/diagnose/verdict/cancelling_effects.h"
#include "tools/diagnose/verdict/followed_signal.h"
#include "tools/diagnose/verdict/held_out_terms.h"
#include "tools/diagnose/verdict/site_additions.h"
#include "tools/diagnose/verdict/site_covariance.h"
#include "tools/diagnose/verdict/site_errors.h"
#include "tools/diagnose/verdict/site_inputs.h"
#include "tools/diagnose/verdict/site_plots.h"
#include "tools/diagnose/verdict/site_units.h"

namespace loopwright::diagnosis {
namespace {

class Telling {
 public:
  Telling(SiteFilter& filter, const SiteSearchResult& search, Diagnosis& result)
      : model_(filter.model()),
        search_(search),
        found_(search.found),
        result_(result),
        fitted_(filter, model_.record().held_out_from, [] { return false; }),
        whole_(filter, model_.record().rows(), [] { return false; }) {}

  void run() {
    leave_out_what_is_nothing();
    covariance_ = covariance_of(fitted_, found_);
    tell_terms(), tell_parameters(), tell_steps();
    if (search_.second_opinion) tell_second_opinion(model_, *search_.second_opinion, result_);
    result_.not_observable = alike_sites(fitted_, found_);
    std::ranges::move(possible_products(model_, found_), std::back_inserter(result_.not_observable));
    std::vector<bool> optional(found_.terms.size()), none(found_.terms.size());
    for (size_t t = 0; t < optional.size(); ++t) optional[t] = result_.effects[t].is_optional;
    if (!simulates_without(whole_, found_, optional, errors_)) {
      optional = none;
      for (DiagnosedEffect& effect : result_.effects) effect.is_optional = false;
    }
    result_.additions = site_additions(model_, found_, optional);
    result_.all_additions = site_additions(model_, found_, none);
    is_input_questioned_ = question_inputs(fitted_, found_, result_.findings);
    judge();
    if (!result_.effects.empty() || !result_.moved_parameters.empty())
      tell_sensors_not_looked_at(model_, found_, result_);
    add_site_plots(fitted_, search_.nominal, found_, result_);
  }

 private:
  DiagnosedParameter number(const std::vector<FittedNumber>& numbers, size_t i, std::string name,
                            std::string unit) const {
    SiteHypothesis h = found_;
    const double value = value_of(h, numbers[i]);
    const double half = 1.96 * std::sqrt(std::max(0.0, covariance_(Eigen::Index(i), Eigen::Index(i))));
    return {std::move(name), std::move(unit), value, value - half, value + half, false};
  }

  /// One that is positive, such as a width, is so in all of its interval.
  DiagnosedParameter own_parameter(const std::vector<FittedNumber>& numbers, size_t i,
                                   const SiteTerm& term) const {
    const auto index = size_t(numbers[i].index);
    DiagnosedParameter p = number(numbers, i, std::string(term.shape->nonlinear[index]),
                                  unit_of_own_parameter(model_, term, index));
    if (term.low[index] >= 0 && p.value >= 0) p.low = std::max(p.low, 0.0);
    return p;
  }

  void tell_terms() {
    const std::vector<FittedNumber> numbers = fitted_numbers(found_);
    SiteHypothesis h = found_;
    SitePass pass;
    const bool has_path = fitted_.pass(h, true, pass);
    for (size_t t = 0; t < found_.terms.size(); ++t) {
      const SiteTerm& term = found_.terms[t];
      const Site& site = model_.sites()[size_t(term.site)];
      DiagnosedEffect effect;
      effect.name = term.shape->name, effect.title = term.shape->title;
      effect.site = site.name, effect.site_unit = unit_text(site.unit), effect.inclusion = 1;
      if (term.variable >= 0) effect.variables.push_back(model_.variables()[size_t(term.variable)].name);
      for (size_t i = 0; i < numbers.size(); ++i) {
        if (numbers[i].kind == FittedNumber::Kind::factor || numbers[i].owner != int(t)) continue;
        const size_t index = size_t(numbers[i].index);
        if (numbers[i].kind == FittedNumber::Kind::nonlinear)
          effect.parameters.push_back(own_parameter(numbers, i, term));
        else if (!is_unknown_function(*term.shape))
          effect.parameters.push_back(number(numbers, i, std::string(term.shape->coefficients[index]),
                                             unit_of_coefficient(model_, term)));
      }
      for (const SiteRival& rival : search_.rivals)
        if (rival.of == place_[t]) effect.alternatives.push_back(describe(model_, rival.term));
      for (const SiteTerm& same : same_beside_zero(fitted_, found_, t))
        if (const std::string text = describe(model_, same);
            std::ranges::find(effect.alternatives, text) == effect.alternatives.end())
          effect.alternatives.push_back(text);
      if (has_path) {
        effect.force_rms = size_of_term(model_, pass, term);
        effect.is_optional =
            effect.force_rms < criteria::material_share_of_site * size_at_site(model_, pass, term.site);
      }
      if (is_unknown_function(*term.shape))
        for (const std::string& v : effect.variables) result_.remainder_variables.push_back(v);
      result_.effects.push_back(std::move(effect));
    }
  }
  void leave_out_what_is_nothing() {
    place_ = terms_that_are_something(fitted_, found_);
    is_left_out_ = place_.size() < found_.terms.size();
    std::vector<SiteTerm> kept;
    for (const size_t t : place_) kept.push_back(found_.terms[t]);
    found_.terms = std::move(kept);
  }

  void tell_parameters() {
    const std::vector<FittedNumber> numbers = fitted_numbers(found_);
    for (size_t i = 0; i < numbers.size(); ++i) {
      if (numbers[i].kind != FittedNumber::Kind::factor) continue;
      const ModelParameter& parameter = model_.parameters()[size_t(numbers[i].owner)];
      const DiagnosedParameter factor = number(numbers, i, "", "");
      const double a = parameter.nominal * factor.low, b = parameter.nominal * factor.high;
      result_.moved_parameters.push_back({parameter.name, parameter.unit, parameter.nominal,
                                          parameter.nominal * factor.value, std::min(a, b), std::max(a, b)});
    }
    std::vector<std::string> moved;
    for (const MovedParameter& p : result_.moved_parameters) moved.push_back(p.name);
    const auto is_told_term = [&](size_t t) { return std::ranges::find(place_, t) != place_.end(); };
    for (const ParameterRival& rival : search_.parameter_rivals) {
      const bool is_of_nothing = found_.terms.empty() && moved.empty();
      if (is_of_nothing || (rival.of && !is_told_term(*rival.of))) continue;
      OtherExplanation other{rival.keeps_parameters ? std::vector<std::string>{} : moved, {}};
      for (int i : rival.moved) other.effects.push_back(model_.parameters()[size_t(i)].name);
      for (const SiteTerm& term : rival.terms) other.effects.push_back(describe(model_, term));
      if (rival.of) other.in_place_of.emplace_back(search_.found.terms[*rival.of].shape->name);
      if (rival.of_all_terms)
        for (const SiteTerm& term : found_.terms) other.in_place_of.emplace_back(term.shape->name);
      const auto is_told = [&](const OtherExplanation& known) {  // of the two that look for single parameters
        return known.in_place_of == other.in_place_of && known.effects == other.effects;
      };
      if (std::ranges::none_of(result_.other_explanations, is_told))
        result_.other_explanations.push_back(std::move(other));
    }
    // Beside terms it may stand for what these do not do exactly, or for an effect that is not named.
    for (const MovedParameter& p : result_.moved_parameters)
      if (!found_.terms.empty() && is_small(p)) result_.other_explanations.push_back({{p.name}, {}});
  }
  static bool is_small(const MovedParameter& p) {
    return std::abs(p.value - p.stated) < criteria::small_change_of_parameter * std::abs(p.stated);
  }
  /// An effect that has no name here bends the parameters that resemble it a little, and a slow disturbance
  /// follows what they leave.
  bool may_stand_for_an_effect() {
    if (result_.moved_parameters.empty() || !result_.effects.empty() || result_.slow_disturbances.empty() ||
        !std::ranges::all_of(result_.moved_parameters, is_small))
      return false;
    result_.findings.push_back({"parameters that are hardly off explain it only beside a slow disturbance",
                                "both may stand for an effect that nothing here names", true, false});
    return true;
  }

  void tell_steps() {
    const auto add = [&](const SiteErrors& errors, std::vector<std::string> added) {
      constexpr double none = std::numeric_limits<double>::quiet_NaN();
      DiagnosisStep step{std::move(added), none, none, none};
      if (!errors.diverges)
        step.force_rmse = errors.predicted[shown_], step.held_out_force_rmse = errors.held_out[shown_],
        step.simulation_rmse = errors.simulated[shown_];
      result_.steps.push_back(std::move(step));
    };
    nominal_ = errors_of(whole_, search_.nominal);
    shown_ = missed_output(nominal_, found_.noise, 0).value_or(0);
    show_output(model_.record().outputs[shown_], result_);
    add(nominal_, {});
    std::vector<std::string> named;
    for (const SiteHypothesis& h : search_.steps) {
      std::vector<std::string> added;
      for (const SiteTerm& term : h.terms)
        if (const std::string name = describe(model_, term); std::ranges::find(named, name) == named.end())
          added.push_back(name), named.push_back(name);
      if (!added.empty()) add(errors_of(whole_, h), added);  // otherwise terms were only removed
    }
    errors_ = errors_of(whole_, found_);
    add(errors_, {"as answered"});
    result_.holds_out = model_.record().held_out_from < model_.record().rows();
    const bool held = result_.holds_out;
    if (!nominal_.diverges)
      result_.error_before = held ? nominal_.held_out[shown_] : nominal_.predicted[shown_];
    if (errors_.diverges) {
      result_.error_after = result_.steps.back().force_rmse;
      return;
    }
    result_.error_after = held ? errors_.held_out[shown_] : errors_.predicted[shown_];
    result_.noise_floor = errors_.noise[shown_];
    result_.mean_square = errors_.mean_square, result_.held_out_mean_square = errors_.held_out_mean_square;
    result_.portmanteau = errors_.portmanteau;
    result_.measurement_noise = found_.noise.measurement;
  }

  std::optional<size_t> missed_by_far() const {
    return missed_output(errors_, found_.noise, criteria::far_simulation);
  }
  size_t changes() const { return result_.effects.size() + result_.moved_parameters.size(); }
  void doubt_changes(std::string what) {
    result_.findings.push_back(
        {std::move(what), "they may stand for one effect that nothing here names", true, false});
  }
  bool are_too_many_changes() {
    if (changes() < criteria::too_many_changes) return false;
    doubt_changes(fmt::format("{} changes at once", changes()));
    return true;
  }
  /// Many changes at once, with which a simulation still misses the record by far, follow it without its
  /// cause.
  bool are_many_changes_in_vain() {
    const std::optional<size_t> missed = missed_by_far();
    if (changes() < criteria::many_changes || !missed) return false;
    const double ratio = errors_.simulated[*missed] / found_.noise.measurement[*missed];
    doubt_changes(
        fmt::format("with {} changes at once a simulation still misses {} by {:.0f} times the noise of its "
                    "sensor",
                    changes(), model_.record().outputs[*missed].port, ratio));
    return true;
  }

  /// Tells what a simulation needs noise in the states for. Whether it misses more than that noise explains.
  bool misses_more_than_noise(bool with_names) {
    std::optional<size_t> worst;
    double most = 0;  // [of what noise explains]
    for (size_t j = 0; j < errors_.simulated.size() && !errors_.diverges; ++j) {
      const double missed = errors_.simulated[j] / found_.noise.measurement[j],
                   share = errors_.simulated[j] / explained_by_noise(errors_, found_.noise, j);
      if (missed > criteria::notable_simulation && share > most) worst = j, most = share;
    }
    if (!worst) return false;
    const double sensor = found_.noise.measurement[*worst];
    result_.findings.push_back(
        {fmt::format(
             "{} a simulation misses {} by {:.2g} times the noise of its sensor, of which noise inside "
             "the plant makes {:.2g} likely",
             with_names ? "with what was found" : "as the diagram is", model_.record().outputs[*worst].port,
             errors_.simulated[*worst] / sensor, errors_.expected_simulated[*worst] / sensor),
         most > 1 ? "an effect that nothing here names may bend what was found"
                  : "it is taken for that noise; it may also be an effect that nothing here names",
         most > 1, false});
    return most > 1;
  }

  /// Terms none of whose coefficients the record tells from zero: together with others they do what one law
  /// of another name may do.
  bool has_untold_terms() {
    bool is_any = false;
    for (size_t t = 0; t < result_.effects.size(); ++t) {
      const auto names = found_.terms[t].shape->coefficients;
      size_t told = 0, all = 0;
      for (const DiagnosedParameter& p : result_.effects[t].parameters)
        if (std::ranges::find(names, p.name) != names.end()) ++all, told += p.low > 0 || p.high < 0;
      if (std::string why = why_levels_cancel(result_.effects[t]); !why.empty())
        is_any = true,
        result_.findings.push_back({std::move(why), "it stands for a law of another name", true, false});
      if (all == 0 || told > 0) continue;
      is_any = true;
      result_.findings.push_back({fmt::format("the intervals of all coefficients of {} contain zero",
                                              describe(model_, found_.terms[t])),
                                  "its name stands for what the record does not tell", true, false});
    }
    return is_any;
  }

  /// Laws of one signal that oppose each other are a series for a function that none of them is.
  bool has_cancelling_names() {
    bool is_any = false;
    for (const StackedNames& names : stacked_names(fitted_, found_, 2)) {
      if (!cancel(fitted_, found_, names)) continue;
      is_any = true;
      std::vector<std::string> list;
      for (const size_t t : names.terms) list.push_back(describe(model_, found_.terms[t]));
      result_.findings.push_back(
          {fmt::format("{} cancel but for a small rest", loopwright::joined(list, " and ")),
           "together they stand for one function that nothing here names", true, false});
    }
    return is_any;
  }

  /// What only the fitted rows ask for follows something else in them.
  bool has_contradicted_terms() {
    if (found_.noise.is_of_simulation) return false;
    const std::vector<size_t> contradicted = contradicted_terms(whole_, found_);
    for (size_t t : contradicted)
      result_.findings.push_back({fmt::format("the held-out rows are predicted better without {}",
                                              describe(model_, found_.terms[t])),
                                  "its name stands for something in the fitted rows alone", true, false});
    return !contradicted.empty();
  }

  /// Tells the slow disturbances of the answer. Whether they are small and follow nothing, as noise does.
  bool are_disturbances_noise() {
    const std::vector<Disturbance> list = disturbances_of(fitted_, found_);
    bool are_noise = true;
    for (size_t i = 0; i < list.size(); ++i) {
      const Disturbance& d = list[i];
      const auto followed = followed_signal(fitted_, found_, i);
      const bool is_noise = d.is_small() && !followed;
      are_noise &= is_noise;
      const Site& site = model_.sites()[size_t(d.site)];
      result_.slow_disturbances.push_back({site.name, unit_text(site.unit), d.size, d.share, d.time});
      result_.findings.push_back(
          {fmt::format("a slow disturbance at {}: {}, {:.1f} % of the signal, alike for {:.2g} s{}",
                       site.name, shown(d.size, unit_text(site.unit)), 100 * d.share, d.time,
                       d.time < fitted_.longest_slow_time() ? "" : " or longer"),
           is_noise ? "it is taken for noise"
           : followed
               ? fmt::format("{:.0f} % of it follow {}: it stands for an effect that nothing here names",
                             100 * followed->share, followed->name)
               : "so much of it may stand for an effect that nothing here names",
           !is_noise, false});
    }
    return are_noise;
  }

  void judge() {
    const bool has_unknown = !result_.remainder_variables.empty();
    const bool are_noise = are_disturbances_noise();  // each of these tells what it finds
    const bool leaves_nothing = is_exact(errors_, model_.record());
    const bool looks_white = !errors_.diverges && !errors_.leaves_slow_error && are_noise &&
                             errors_.portmanteau < criteria::most_portmanteau_of_any_diagram;
    const bool is_white = leaves_nothing || looks_white;
    const bool names = !result_.effects.empty() || !result_.moved_parameters.empty();
    const bool worse = names && simulates_worse(errors_, nominal_, result_.holds_out);
    const bool is_untold = has_untold_terms(),
               are_too_many = are_too_many_changes() || are_many_changes_in_vain(),
               is_contradicted = has_contradicted_terms(), cancels = has_cancelling_names(),
               is_open = (names && search_.second_opinion && search_.second_opinion->is_open() &&
                          missed_by_far()) ||
                         is_untold || are_too_many || is_contradicted || cancels ||
                         (names && is_input_questioned_);
    const bool is_nothing = !names && (is_left_out_ || leaves_nothing);
    const bool is_bent = !is_nothing && misses_more_than_noise(names);
    const bool misses_held_out =
        result_.holds_out && !errors_.diverges && !leaves_nothing &&
        result_.held_out_mean_square > criteria::most_held_out * std::max(1.0, result_.mean_square);
    if (misses_held_out && !is_nothing)
      result_.findings.push_back({"the held-out rows are predicted worse than the rows that were fitted",
                                  "what was found does not hold everywhere", true, false});
    if (is_left_out_ || (is_nothing && !looks_white))
      result_.findings.push_back(
          {"what remains is as small as the errors of the arithmetic", "it is not named"});
    if (worse)
      result_.findings.push_back(
          {"with what was found, a simulation is worse than that of the diagram as it is",
           "names and parameters stand for something else", true, false});
    if (is_nothing)
      result_.verdict = Verdict::nothing_missing;
    else if (worse || (!names && (!is_white || is_bent || misses_held_out)))
      result_.verdict = Verdict::unexplained;
    else if (!is_white || is_open || is_bent || misses_held_out ||
             (!leaves_nothing && may_stand_for_an_effect()))
      result_.verdict = Verdict::partly_explained;
    else if (has_unknown)
      result_.verdict = Verdict::partly_explained, result_.lacks_only_a_name = true;
    else
      result_.verdict = names ? Verdict::explained : Verdict::nothing_missing;
  }

  SiteModel& model_;
  const SiteSearchResult& search_;
  SiteHypothesis found_;
  std::vector<size_t> place_;  ///< of each of its terms among those of the search
  bool is_left_out_ = false, is_input_questioned_ = false;
  size_t shown_ = 0;  ///< the output whose errors are told
  Diagnosis& result_;
  SiteFitter fitted_, whole_;
  Eigen::MatrixXd covariance_;
  SiteErrors nominal_, errors_;
};

}  // namespace

void show_output(const RecordedOutput& output, Diagnosis& result) {
  result.measured_port = output.port, result.measured_unit = result.force_unit = output.unit;
}

void tell_sites(SiteFilter& filter, const SiteSearchResult& search, Diagnosis& result) {
  Telling(filter, search, result).run();
}

}  // namespace loopwright::diagnosis
