#include "tools/diagnose/verdict/verdict.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "tools/compare/excitation.h"
#include "tools/compare/missing_force.h"
#include "tools/diagnose/search/rest.h"
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/doubt.h"
#include "tools/diagnose/search/names.h"
#include "tools/diagnose/search/wandering_sensor.h"
#include "tools/diagnose/verdict/cancelling_effects.h"
#include "tools/diagnose/verdict/open_answers.h"
#include "tools/diagnose/verdict/remainder_interval.h"
#include "tools/diagnose/verdict/undetermined.h"

namespace loopwright::diagnosis {

SuggestedExperiment separating_experiment(const Effect& effect, const std::string& other) {
  for (const ConfusableEffect& confusable : effect.confusable)
    if (confusable.with == other) return {confusable.experiment.text, effect.name, other};
  return {
      "Repeat the motion in both directions, at five speeds from very slow to fast, with a known mass on the "
      "axis.",
      effect.name, other};
}

namespace {

void add_variables(std::vector<std::string>& list, std::string_view joined) {
  for (size_t from = 0; from <= joined.size();) {
    const size_t comma = std::min(joined.find(',', from), joined.size());
    const std::string name(joined.substr(from, comma - from));
    if (std::ranges::find(list, name) == list.end()) list.push_back(name);
    from = comma + 1;
  }
}

/// Why the residual force is no noise, in words; empty: it may be.
/// `repeating`: the force that coarse counts feign, which is the same in every repeat of a motion.
std::string force_above_noise(const Trials& trials, const std::vector<InverseDynamics>& inverse,
                              const std::vector<Member>& members, double repeating) {
  // An impact that is predicted a moment too late leaves a large force for a moment.
  if (trials.has_map() || may_be_doubtful(members)) return {};
  for (size_t t = 0; t < trials.list.size(); ++t) {
    const MeasuredMotion motion = away_from_turns(inverse[t]);
    const std::vector<double> residual = residual_with(trials.list[t], inverse[t], members);
    double square = 0, n = 0;
    for (size_t k = 0; k < residual.size(); ++k)
      if (motion.counts[k]) square += residual[k] * residual[k], n += 1;
    if (n < criteria::least_rows) continue;
    const double rms = std::sqrt(square / n);
    NoiseFloor floor = noise_floor(motion, residual);
    const double independent = n * motion.sample_time / criteria::slow_memory_s,
                 followed = floor.repeat_s > 0 ? 0 : criteria::levels_of_smooth_functions / independent;
    if (floor.value <= 0 || followed > criteria::most_levels) continue;
    floor.value = std::max(floor.value, repeating);
    const double most = criteria::most_over_floor / std::sqrt(1 - followed);
    const double excess = std::sqrt(std::max(0.0, rms * rms - floor.value * floor.value));
    if (rms > most * floor.value && excess > criteria::least_excess * trials.force_rms)
      return fmt::format("the residual force is {:.2f} times what noise alone leaves, seen from {}",
                         rms / floor.value, floor.source);
  }
  return {};
}

/// Whether the estimated noise would leave far more force than there is. Beside impacts this says nothing,
/// and a record without noise has the least that the search assumes.
bool is_noise_inflated(const Trials& trials, const std::vector<Member>& members, const Diagnosis& diagnosis) {
  const double floor = diagnosis.noise_floor;
  return !trials.has_map() && !may_be_doubtful(members) &&
         floor > criteria::least_excess * trials.force_rms &&
         diagnosis.steps.back().force_rmse < criteria::least_residual_of_noise * floor;
}

/// Whether the smoothed motion is that of the axis: it moves for a while from turn to turn, in which the
/// filter of the residual sees many rows.
bool has_long_ways(const std::vector<InverseDynamics>& inverse) {
  constexpr double least_rows = 40, least_s = 0.05;  // in motion, from a turn to the next
  const auto has = [&](const MeasuredMotion& m) {
    const auto moves = [&](double v) { return std::abs(v) > m.rest_speed; };
    const double rows = std::max(least_rows, least_s / m.sample_time);
    return double(std::ranges::count_if(m.velocity, moves)) >= rows * double(reversals_in(m));
  };
  return std::ranges::all_of(inverse, has, &InverseDynamics::motion);
}

/// Where noise_floor() of compare takes what is left for noise, the noise that was estimated may say
/// otherwise: between the readings of a slower sensor several names can share one law, as dry friction and
/// drags that cancel; a load that is not held as the diagram or the catalogue has it swings; a reading leaps.
std::string force_far_above_noise(const Trials& trials, const std::vector<Member>& members,
                                  const std::vector<InverseDynamics>& inverse, const Diagnosis& diagnosis) {
  if (trials.has_map() || !balances_forces(trials, inverse)) return {};
  const auto is_read_too_seldom = [](const Trial& t) { return t.model->record().acts_between_readings; };
  const bool has_impacts = may_be_doubtful(members);
  const double left = diagnosis.steps.back().force_rmse, floor = diagnosis.noise_floor;
  const bool is_known = has_long_ways(inverse) || std::ranges::any_of(trials.list, is_read_too_seldom);
  // Of an error of the sensor the balance takes the acceleration, which is only nearly that of the motion.
  const auto is_beside_balance = [](const Member& m) {
    return is_own_load(m) || m.candidate->acts == Acts::sensor;
  };
  const bool is_asked = has_impacts || (is_known && std::ranges::none_of(members, is_beside_balance));
  const double most = has_impacts ? criteria::far_over_noise_beside_impacts : criteria::far_over_noise;
  const double excess = std::sqrt(std::max(0.0, left * left - floor * floor));
  if (!is_asked || left <= most * floor || excess <= criteria::least_excess * trials.force_rms) return {};
  return fmt::format("the residual force is {:.1f} times what the estimated noise leaves", left / floor);
}

/// A gain, mostly with a damping, states the law of another inertia.
std::string why_inertia_is_open(const Trials& trials, const Diagnosis& diagnosis) {
  if (trials.has_map()) return {};
  const auto lists_inertia = [](const NotLookedFor& list) {
    return std::ranges::find(list.effects, "inertia") != list.effects.end();
  };
  const bool is_open =
      std::ranges::any_of(diagnosis.not_looked_for, lists_inertia) &&
      std::ranges::find(diagnosis.effects, "force_gain", &DiagnosedEffect::name) != diagnosis.effects.end();
  return is_open ? "what is called force_gain may be another inertia, which could not be looked for" : "";
}

/// What makes up for a missing effect in the fitted rows need not do so in others.
std::string held_out_force_above_fitted(const Trials& trials, const std::vector<Member>& members,
                                        const std::vector<InverseDynamics>& inverse,
                                        const Diagnosis& diagnosis) {
  if (!diagnosis.holds_out || trials.has_map() || may_be_doubtful(members)) return {};
  const double held_out = diagnosis.steps.back().held_out_force_rmse,
               left = std::max(diagnosis.steps.back().force_rmse, diagnosis.noise_floor);
  const double excess = std::sqrt(std::max(0.0, held_out * held_out - left * left));
  if (!(held_out > criteria::most_held_out_force * left) || !balances_forces(trials, inverse) ||
      excess <= criteria::least_excess * trials.force_rms)
    return {};
  return fmt::format("the residual force of the held-out rows is {:.2f} times that of the fitted ones",
                     held_out / left);
}

/// Whether the counts of the sensor may have made all that the predictions leave, and no force that matters
/// remains. What counts make is computed for one course of the noise: that of the record may make more.
bool is_made_by_counts(const Trials& trials, const Conclusion& conclusion, const Diagnosis& diagnosis) {
  const double left = diagnosis.steps.back().force_rmse, floor = diagnosis.noise_floor;
  const double rows = double(fitted_numbers(trials)) / double(trials.ports());
  return conclusion.estimate.members.empty() && conclusion.is_remainder_noise &&
         conclusion.counts_portmanteau > criteria::least_share_of_counts * conclusion.portmanteau &&
         conclusion.portmanteau_beside_counts() < criteria::most_portmanteau_per_row * rows &&
         left * left - floor * floor < std::pow(criteria::least_excess * trials.force_rms, 2);
}

double longest_record_s(const Trials& trials) {
  double longest = 0;
  for (const Trial& trial : trials.list)
    longest = std::max(longest, double(trial.usable.size()) * trial.model->record().sample_time);
  return longest;
}

/// In noise that is no smaller than what drives, a name for a part of it explains nothing by itself: the
/// diagram must simulate better with it.
std::string lost_in_noise(const Trials& trials, const Estimate& e, const Diagnosis& diagnosis) {
  const double share = e.noise.white / trials.force_rms;
  const double before = diagnosis.steps.front().simulation_rmse,
               after = diagnosis.steps.back().simulation_rmse;
  const bool simulates_better = after < (1 - criteria::least_help) * before;
  if (e.members.empty() || trials.has_map() || !(share > criteria::noise_that_hides) || simulates_better)
    return {};
  return fmt::format(
      "white noise of the force is {:.0f} % of what drives, and no simulation is better with what was "
      "found: it may stand for something else",
      100 * share);
}

}  // namespace

void judge(Trials& trials, const Conclusion& conclusion, const Motion& motion, const Noise& tight,
           const std::vector<InverseDynamics>& inverse, Diagnosis& diagnosis) {
  const Estimate& e = conclusion.estimate;
  for (const Member& member : e.members)
    if (member.candidate->is_unknown) add_variables(diagnosis.remainder_variables, member.candidate->form);
  const bool has_unknown = !diagnosis.remainder_variables.empty();
  // What was refused had explained something that the counts of the sensor alone may not.
  const bool is_left = !std::ranges::all_of(diagnosis.refused, &RefusedEffect::is_blurred) &&
                       e.members.empty() && !conclusion.is_negligible &&
                       conclusion.portmanteau > criteria::most_portmanteau;
  bool is_not_white = is_left || !(conclusion.is_white() || is_made_by_counts(trials, conclusion, diagnosis));
  const bool is_counted = conclusion.counts_portmanteau > criteria::most_portmanteau_of_counted;
  const double repeating = is_counted ? residual_of_sensor(trials, e) : 0;
  if (std::string why = force_above_noise(trials, inverse, e.members, repeating); !why.empty())
    diagnosis.contradictions.push_back(std::move(why));
  else if (why = force_far_above_noise(trials, e.members, inverse, diagnosis); !why.empty())
    diagnosis.contradictions.push_back(std::move(why));
  else if (why = held_out_force_above_fitted(trials, e.members, inverse, diagnosis); !why.empty())
    diagnosis.contradictions.push_back(std::move(why));
  for (const RefusedEffect& refused : diagnosis.refused)
    if (refused.is_of_sensor)
      diagnosis.contradictions.push_back(
          fmt::format("what resembles {} is not in the diagram: {}", refused.effect, refused.why));
  if (!std::isfinite(diagnosis.mean_square))
    diagnosis.contradictions.push_back("the errors of the predictions could not be judged");
  for (std::string why : {why_input_is_taken_away(trials, e), why_effects_cancel(diagnosis),
                          lost_in_noise(trials, e, diagnosis), why_inertia_is_open(trials, diagnosis),
                          why_sensor_is_open(diagnosis), why_optional_effects_are_open(diagnosis)})
    if (!why.empty()) diagnosis.contradictions.push_back(std::move(why));
  for (const DiagnosedEffect& effect : diagnosis.effects)
    if (std::string why = why_not_determined(effect, longest_record_s(trials)); !why.empty())
      diagnosis.contradictions.push_back(std::move(why));
  if (diagnosis.simulation_diverged)
    diagnosis.contradictions.push_back("the diagram with these effects diverges when it is simulated");
  else if (diagnosis.simulation_is_worse)
    diagnosis.contradictions.push_back("the diagram simulates worse with these effects than without them");
  for (const Member& member : e.members) {
    const std::string& name = member.candidate->name;
    if (!member.candidate->is_unknown && is_at_limit(member))
      diagnosis.contradictions.push_back("a parameter of " + name +
                                         " is at the limit of its range, where it stands for something else");
    if (!is_own_load(member)) continue;
    // What the counts excuse may also be a load that moves otherwise: neither whiteness nor simulation can
    // tell.
    if (is_counted)
      diagnosis.contradictions.push_back("the counts of the sensor are too coarse to show how the load of " +
                                         name + " moves: its parameters are not certain");
  }
  if (is_not_white && !is_counted && std::ranges::none_of(e.members, is_own_load))
    if (const auto sensor = wandering_sensor(trials, e);
        sensor && sensor->gain > criteria::least_gain_of_offset_alone)
      diagnosis.contradictions.push_back(described(trials, *sensor));
  if (conclusion.comes_in_bursts)
    diagnosis.contradictions.push_back(
        "large errors keep together in time: something happens now and then that is not explained, as "
        "pushes, the blows of a load that rattles, or one record of several that is unlike the others");
  if (is_noise_inflated(trials, e.members, diagnosis))
    diagnosis.contradictions.push_back(
        "the errors ask for more noise than the forces show: they are not alike over the record, so that "
        "something happened that is no noise");
  if (against_at_rest(trials, e.members, *e.fitted, e.noise, criteria::least_rest_s) > criteria::least_gain)
    diagnosis.contradictions.push_back(
        "while the axis rests, its input pushes it more than anything in the diagram holds, or nothing "
        "holds it though something should");
  if (is_not_white && diagnosis.contradictions.empty() && !conclusion.is_remainder_noise)
    diagnosis.contradictions.push_back("a slow force remains that is more than noise");
  else if (is_not_white && diagnosis.contradictions.empty())
    diagnosis.contradictions.push_back(fmt::format(
        "the errors of the predictions are no noise: n Σ ρ² over {} lags is {:.0f}, of which the counts "
        "of the sensor make {:.0f}",
        criteria::portmanteau_lags, conclusion.portmanteau, conclusion.counts_portmanteau));
  is_not_white |= !diagnosis.contradictions.empty();
  if (is_not_white || has_unknown) {
    const Estimate seen = fit_members(trials, named_members(e.members), tight, motion, 0);
    diagnosis.dependence = dependence_of(trials, *seen.fitted);
    diagnosis.remainder_interval = interval_of_remainder(trials, *seen.fitted);
    if (!has_unknown && !diagnosis.dependence.empty() &&
        diagnosis.dependence.front().share > criteria::least_dependence)
      add_variables(diagnosis.remainder_variables, diagnosis.dependence.front().variable);
  }
  const bool is_fatal = std::ranges::any_of(diagnosis.findings, &RecordFinding::is_fatal);
  const bool leftover = is_not_white || has_unknown;
  if (diagnosis.effects.empty())
    diagnosis.verdict = leftover ? Verdict::unexplained : Verdict::nothing_missing;
  else
    diagnosis.verdict = leftover ? Verdict::partly_explained : Verdict::explained;
  if (!is_fatal) return;
  diagnosis.verdict = Verdict::unexplained;
}

}  // namespace loopwright::diagnosis
