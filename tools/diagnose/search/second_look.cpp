#include "tools/diagnose/search/second_look.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/drifting_position.h"
#include "tools/diagnose/search/merged_rows.h"
#include "tools/diagnose/search/noisy_input.h"
#include "tools/diagnose/search/remaining_force.h"
#include "tools/diagnose/search/weight.h"

namespace loopwright::diagnosis {

namespace {

/// Whether all rows count that count without it: a load that flies leaves rows out, except where it is a
/// state of the predictor.
bool leaves_no_row_out(const Estimate& trial, const Candidate& candidate) {
  return !candidate.flies ||
         std::ranges::all_of(*trial.fitted, [&](const Fitted& f) { return f.flying == &candidate; });
}

/// What stands at the end of its range stands for something else.
bool may_be_told(const Trials& trials, const Estimate& trial, size_t member, const Weight& weight) {
  const Candidate& candidate = *trial.members[member].candidate;
  return !candidate.is_unknown && leaves_no_row_out(trial, candidate) &&
         !is_at_limit(trial.members[member]) && !is_blurred(trials, trial.members[member]) &&
         !spoils_balance(trials, trial, member, weight) &&
         !is_feigned_by_noise(trials, trial.members, member);
}

/// A second law of dry friction, beside the one that was chosen where reversals show the difference.
bool is_another_dry_friction(const Candidate& candidate, const std::vector<Member>& members) {
  return is_dry_friction(candidate) && has_dry_friction(members);
}

/// Beside next to no noise the arithmetic of the diagram has effects too.
bool is_error_of_model(const Trials& trials, const Estimate& trial, const Weight& weight) {
  const double error = criteria::error_of_model * trials.force_rms / force_of_an_error(trial.noise);
  return weight.wald < error * error * double(fitted_numbers(trials));
}

/// A small delay or lag, which may be no more than a controller that answers noise. Beside a velocity sensor
/// alone none is believed.
bool may_be_answer_to_noise(Trials& trials, const Estimate& trial, size_t catalogue) {
  if (!is_late_input(*trial.members.back().candidate)) return false;
  return !measure_position(trials) || smoothing_gains(trials, trial, catalogue);
}

/// A force that matters by its size, of which members that are there leave little: another name for a part of
/// theirs.
bool is_another_name(const Trials& trials, const Weight& weight) {
  return weight.force_rms > criteria::force_that_matters * trials.force_rms;
}

/// Whether the last member of `trial` explains next to nothing beside that of `feigned`, which says the same
/// better and is none.
bool is_another_name_of(Trials& trials, const Estimate& feigned, const Estimate& trial, size_t catalogue,
                        double least) {
  constexpr int iterations = 8;
  std::vector<Member> both = feigned.members;
  both.push_back(trial.members.back());
  const Estimate beside = fit_members(trials, std::move(both), feigned.noise, feigned.motion, iterations);
  return !beside.is_valid ||
         criterion(trials, feigned, catalogue) - criterion(trials, beside, catalogue) < least;
}

bool is_beat_of_counts(const Weight& weight) {
  return weight.wald < criteria::clear_of_counts * weight.counts;
}

}  // namespace

SecondLook look_again(Trials& trials, const Estimate& estimate, double portmanteau, const Evidence& evidence,
                      size_t catalogue) {
  constexpr size_t most_tried = 5;  // of something small, several laws say the same
  constexpr int iterations = 8;
  SecondLook result;
  // In noise that is assumed, or errors that are not white, small effects are the errors of the model.
  const bool is_noisy = estimate.noise.white > 2 * criteria::least_white_noise * trials.force_rms;
  if (!is_noisy || portmanteau > criteria::most_portmanteau_of_counted) return result;
  const double least = std::max(criteria::least_gain, criteria::least_gain_per_row * judged_numbers(trials));
  std::vector<Proposal> proposals = evidence.extensions(double(fitted_numbers(trials)));
  std::erase_if(proposals, [&](const Proposal& p) {
    return is_another_dry_friction(*p.added.front().candidate, estimate.members);
  });
  if (proposals.size() > most_tried) proposals.resize(most_tried);
  std::optional<Estimate> drift;  // a member that a position feigns which nobody measures
  for (const Proposal& proposal : proposals) {
    if (2 * proposal.gain < least || trials.work->is_spent(criteria::work_with_rivals)) break;
    Estimate trial =
        fit_members(trials, applied(proposal, estimate.members), estimate.noise, estimate.motion, iterations);
    trial = with_own_noise(trials, std::move(trial), iterations);
    if (!trial.is_valid) continue;
    const double gain = criterion(trials, estimate, catalogue) - criterion(trials, trial, catalogue);
    const size_t member = trial.members.size() - 1;
    const std::string& name = trial.members.back().candidate->name;
    result.trail.push_back(fmt::format("with the noise known, {}: criterion {:+.1f}", name, -gain));
    if (gain < least) continue;
    const Weight weight = weigh_all(trials, trial).back();
    if (drift && is_another_name_of(trials, *drift, trial, catalogue, least)) continue;
    if (is_feigned_by_drift(trials, trial.members, trial.noise, member)) {
      if (!drift) drift = std::move(trial);
      continue;
    }
    if (!may_be_told(trials, trial, member, weight)) continue;
    if (may_be_answer_to_noise(trials, trial, catalogue)) continue;
    if (material(trials, trial, weight) >= 1) {
      result.better = std::move(trial);
      return result;
    }
    const Member& small = trial.members.back();
    if (is_own_load(small) || is_another_name(trials, weight) || is_error_of_model(trials, trial, weight) ||
        is_beat_of_counts(weight))
      continue;
    result.small.push_back({small.candidate, gain, weight.force_rms});
  }
  std::ranges::stable_sort(result.small, std::ranges::greater{}, &SmallEffect::gain);
  return result;
}

}  // namespace loopwright::diagnosis
