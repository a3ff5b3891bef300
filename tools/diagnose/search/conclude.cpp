#include "tools/diagnose/search/conclude.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <optional>
#include "tools/diagnose/search/doubt.h"
#include "tools/diagnose/search/drifting_position.h"
#include "tools/diagnose/search/flights.h"
#include "tools/diagnose/search/gaps.h"
#include "tools/diagnose/search/law_swaps.h"
#include "tools/diagnose/search/laws_of_one_variable.h"
#include "tools/diagnose/search/merged_rows.h"
#include "tools/diagnose/search/noisy_input.h"
#include "tools/diagnose/search/one_direction.h"
#include "tools/diagnose/search/prune.h"
#include "tools/diagnose/search/remaining_force.h"
#include "tools/diagnose/search/rivals.h"
#include "tools/diagnose/search/shape_swaps.h"
#include "tools/diagnose/search/spectrum.h"
#include "tools/diagnose/search/whiteness.h"

namespace loopwright::diagnosis {
namespace {

using namespace criteria;

/// What a set leaves unexplained, in twice the log-likelihood: approximately the gain of a model of the
/// errors' autocorrelation. A set that is worse by less cannot be excluded. Beyond the limit of white errors
/// there is no bound.
double unexplained(double portmanteau) {
  return std::clamp(portmanteau - double(criteria::portmanteau_lags), 0.0,
                    criteria::most_portmanteau_of_search);
}

/// The same beside what the counts of the sensor make of it.
double unexplained_beside_counts(const Trials& trials, const Estimate& estimate) {
  const double all = portmanteau(trials, *estimate.fitted);
  if (all <= most_portmanteau_of_counted) return unexplained(all);
  const WhitenedErrors counted = errors_of_counts(trials, estimate);
  return unexplained(counted.empty() ? all : all - reach_of_counts * portmanteau_of_counts(trials, counted));
}

/// Whether one candidate replaces the same member.
bool contains(const std::vector<Proposal>& list, const Proposal& proposal) {
  return std::ranges::any_of(list, [&](const Proposal& p) {
    return p.removed == proposal.removed && p.added[0].candidate == proposal.added[0].candidate;
  });
}

/// A parameter at the end of its range indicates that a simpler set is sufficient: one with fewer parameters
/// that is not out of reach.
std::optional<Estimate> simplified(Rivals& rivals, const std::vector<Member>& members,
                                   const std::vector<Proposal>& exchanges) {
  constexpr double most_reaches = 10;  // promised beyond that, none is fitted
  for (size_t m = 0; m < members.size(); ++m) {
    const Member& member = members[m];
    if (!is_at_limit(member)) continue;
    for (const Proposal& proposal : exchanges) {
      const bool is_simpler = proposal.removed == std::vector<size_t>{m} && proposal.added.size() == 1 &&
                              parameters_of(*proposal.added[0].candidate) < parameters_of(*member.candidate);
      if (!is_simpler || proposal.gain <= -most_reaches * rivals.reach() || rivals.is_spent()) continue;
      Estimate other = rivals.fitted(proposal);
      const bool is_good = rivals.loss_of(proposal, other) || rivals.is_promised(proposal, other);
      if (is_good && !rivals.is_refuted(proposal, other)) return other;
    }
  }
  return {};
}

/// The same law by fewer members: a mass alone is simpler than a gain and a damping that make up for it, and
/// a gain is simpler than a mass and a damping in proportion. Such an answer is wrong, not only one of
/// several, so that it is asked for although no further rival is.
std::optional<Estimate> same_law_by_fewer(Trials& trials, Rivals& rivals, const std::vector<Member>& members,
                                          const std::vector<Candidate>& candidates) {
  for (const Proposal& swap : law_swaps(members, candidates, trials)) {
    if (trials.work->is_spent(criteria::work_to_go_on)) return {};
    Estimate other = rivals.fitted(swap);
    // A change so large needs more steps than a rival, and noise of its own.
    if (other.is_valid && !rivals.loss_of(swap, other, reach_of_same_law)) maximise(trials, other);
    // Beside no noise the arithmetic of a law decides how well it predicts.
    const bool leaves_nothing = other.is_valid && is_negligible(trials, other.members);
    if (!leaves_nothing && !rivals.loss_of(swap, other, reach_of_same_law)) continue;
    const size_t needed = size_t(std::ranges::count_if(weigh_all(trials, other), [&](const Weight& weight) {
      return material(trials, other, weight) >= 1;
    }));
    if (needed < members.size()) return other;
  }
  return {};
}

/// A law of the catalogue in place of a function without a name, if it leaves nothing that matters: the one
/// with the fewest parameters. Beside next to no noise a function that adapts itself to small errors of a law
/// predicts better in any case.
std::optional<Estimate> named(const Trials& trials, Rivals& rivals, const std::vector<Member>& members,
                              const std::vector<Proposal>& exchanges) {
  constexpr size_t most_tried = 8;
  size_t tried = 0, fewest = 0;
  std::optional<Estimate> best;
  for (const Proposal& proposal : exchanges) {
    const bool names_one = proposal.removed.size() == 1 && proposal.added.size() == 1 &&
                           members[proposal.removed[0]].candidate->is_unknown &&
                           !proposal.added[0].candidate->is_unknown;
    if (!names_one || rivals.is_spent() || ++tried > most_tried) continue;
    const size_t parameters = parameters_of(*proposal.added[0].candidate);
    Estimate other = rivals.fitted(proposal);
    if (!other.is_valid || !is_negligible(trials, other.members) || (best && parameters >= fewest)) continue;
    best = std::move(other), fewest = parameters;
  }
  return best;
}

/// How far each member is above all thresholds.
std::vector<double> sizes_of_members(const Trials& trials, const Conclusion& result) {
  std::vector<double> sizes;
  for (size_t m = 0; m < result.weights.size(); ++m)
    sizes.push_back(spoils_balance(trials, result.estimate, m, result.weights[m]) ||
                            is_feigned_by_noise(trials, result.estimate.members, m) ||
                            is_feigned_by_drift(trials, result.estimate.members, result.estimate.noise, m) ||
                            is_feigned_within_rows(trials, result.estimate, m, result.weights[m])
                        ? 0
                        : material(trials, result.estimate, result.weights[m]));
  return sizes;
}

/// The member furthest below the thresholds; of several that spoil the balance of the forces, the one that
/// the record asks for least.
size_t weakest_of(const std::vector<double>& sizes, const std::vector<Weight>& weights) {
  const auto strength = [&](size_t m) { return std::pair(sizes[m], weights[m].wald); };
  size_t weakest = 0;
  for (size_t m = 1; m < sizes.size(); ++m)
    if (strength(m) < strength(weakest)) weakest = m;
  return weakest;
}

/// Fits all parameters and the noise together, and removes the members that are not material, one by one, the
/// weakest first. The search judged them with noise that it knew only partly; a barely material member, and
/// what a controller that answers to noise may feign, must explain more than noise that is fitted without it.
void keep_material(Trials& trials, Conclusion& result, size_t catalogue) {
  constexpr int iterations = 4;
  Estimate& estimate = result.estimate;
  for (;;) {
    maximise(trials, estimate);
    if (!estimate.members.empty()) estimate = with_own_motion(trials, std::move(estimate), iterations);
    result.weights = weigh_all(trials, estimate);
    if (estimate.members.empty()) return;
    std::vector<double> sizes = sizes_of_members(trials, result);
    if (std::ranges::min(sizes) >= 1) {  // an effect may have taken all of the beat of the counts
      weigh_counts(trials, estimate, result.weights);
      sizes = sizes_of_members(trials, result);
    }
    size_t weakest = weakest_of(sizes, result.weights);
    if (sizes[weakest] >= barely_material) {
      weakest = size_t(std::ranges::find_if(estimate.members, is_late_member) - estimate.members.begin());
      if (weakest == estimate.members.size()) return;
    }
    const double least = sizes[weakest];
    Estimate without = fit_members(trials, without_one(estimate.members, weakest), estimate.noise,
                                   estimate.motion, iterations);
    if (least >= 1) {
      maximise(trials, without);
      const double doubt =
          is_late_member(estimate.members[weakest]) ? unexplained_beside_counts(trials, estimate) : 0;
      if (criterion(trials, without, catalogue) >
          criterion(trials, estimate, catalogue) + std::max(doubt, least_gain))
        return;
    }
    const Weight& weight = result.weights[weakest];
    result.trail.push_back(
        fmt::format("{}: {}, χ² {:.0f} (of counts {:.0f}), force {:.3g}, unique {:.3g} beside a driving "
                    "force of {:.3g} and "
                    "noise of {:.3g} and {:.3g}",
                    least < 1 ? "not material" : "other noise does as well",
                    estimate.members[weakest].candidate->name, weight.wald, weight.counts, weight.force_rms,
                    weight.unique_force, trials.force_rms, estimate.noise.white, estimate.noise.slow()));
    estimate = std::move(without);
  }
}

/// Of a record whose rows were put together, a delay and a lag of a few of the new rows. Within a row the
/// controller has already answered to noise that the predictor has not yet seen; which of the two predicts
/// better is then no proof.
void add_blurred_shapes(const Trials& trials, Conclusion& result, const std::vector<Candidate>& candidates) {
  const std::vector<Member>& members = result.estimate.members;
  for (size_t m = 0; m < members.size(); ++m) {
    if (!is_blurred(trials, members[m])) continue;
    add_other_late_inputs(result.substitutes[m], members, candidates);
    for (const Member& other : members)
      if (is_late_member(other) && other.candidate != members[m].candidate)
        result.other_sets.push_back({{other.candidate, members[m].candidate}, {members[m].candidate}, 0});
  }
}

/// Where only a velocity is measured, the other shape of a late input: see measure_position().
void add_late_shapes(const Trials& trials, Conclusion& result, Rivals& rivals,
                     const std::vector<Proposal>& swaps, size_t catalogue) {
  if (measure_position(trials)) return;
  const double own = criterion(trials, result.estimate, catalogue);
  for (const Proposal& swap : swaps) {
    const Candidate& other = *swap.added.front().candidate;
    if (swap.removed.size() != 1 || swap.added.size() != 1 || !is_late_input(other) || rivals.is_spent())
      continue;
    const size_t m = swap.removed.front();
    const Estimate fitted = rivals.fitted(swap);
    if (fitted.is_valid &&
        criterion(trials, fitted, catalogue) - own < criteria::share_of_controller * result.weights[m].loss)
      add_if_new(result.substitutes[m], &other);
  }
}

/// Laws of one variable that others of it replace together.
std::vector<OtherSet> laws_beside(const Trials& trials, const Estimate& estimate,
                                  const std::vector<Candidate>& candidates, Rivals& rivals,
                                  double most_loss) {
  std::vector<OtherSet> laws;
  for (const LawOf variable : {LawOf::velocity, LawOf::position})
    if (!rivals.is_spent())
      std::ranges::move(
          other_sets_of_laws(rivals, estimate.members,
                             other_laws(trials, estimate, candidates, variable, most_loss, rivals.refused())),
          std::back_inserter(laws));
  return laws;
}

/// How likely a member is: alternatives that do as well share its probability. The loss of its removal counts
/// in full, that of an alternative by half, because it is that of a fit of few steps.
double inclusion_of(const Weight& weight, const std::vector<Substitute>& substitutes) {
  constexpr double most_certain = 0.995, most_loss = 600;  // [-2 ln L] beyond it nothing changes
  double others = std::exp(-std::min(weight.loss, most_loss) / 2);
  for (const Substitute& s : substitutes) others += std::exp(-std::max(s.loss, 0.0) / 4);
  return most_certain / (1 + others);
}

/// [-2 ln L] Of two shapes at a time, see error_of_promise.
constexpr double error_of_promise_for_two = 30;

/// Computes the alternatives, and from them the probability of each member.
void ask_rivals(const Trials& trials, Conclusion& result, Evidence& evidence,
                const std::vector<Proposal>& exchanges, const std::vector<Candidate>& candidates,
                Rivals& rivals, const FrictionAtReversals& at_reversals, double n) {
  const double reach = rivals.reach(), far = std::max(error_of_promise, 3 * reach);
  const std::vector<Member>& members = result.estimate.members;
  std::vector<Proposal> several = evidence.exchanges_for_pairs();
  std::ranges::copy(exchanges, std::back_inserter(several));
  const double far_off = std::max(error_of_promise_for_two, reach);
  std::erase_if(several, [&](const Proposal& p) { return p.gain < -far_off; });
  std::ranges::stable_sort(several, std::ranges::greater{}, &Proposal::gain);
  result.other_sets = other_sets(rivals, members, several);
  std::vector<Proposal> swaps = shape_swaps(members, candidates);
  std::ranges::move(law_swaps(members, candidates, trials), std::back_inserter(swaps));
  std::vector<Proposal> near = swaps;
  for (const Proposal& p : exchanges)
    if (p.gain > -far && !contains(swaps, p)) near.push_back(p);
  if (!rivals.is_spent())
    std::ranges::move(gaps_for_springs(trials, result.estimate, candidates), std::back_inserter(near));
  const std::vector<OtherSet> laws = laws_beside(trials, result.estimate, candidates, rivals, far_off);
  add_laws(laws, result.other_sets);
  const std::vector<double> removal = evidence.gains_of_removal(n);
  for (size_t m = 0; m < members.size(); ++m) {
    result.weights[m].loss = -removal[m];
    const bool is_not_compared = is_late_member(members[m]) && rivals.is_spent();
    result.substitutes.push_back(
        substitutes_of(rivals, m, *members[m].candidate, near, result.weights[m].loss));
    add_laws(laws, *members[m].candidate, result.weights[m].loss, result.substitutes.back());
    add_simpler_friction(result.substitutes.back(), trials, rivals, result.estimate, m, exchanges);
    for (const auto& [member, law] : at_reversals.not_excluded())
      if (member == m) add_if_new(result.substitutes.back(), law);
    if (is_not_compared) add_other_late_inputs(result.substitutes.back(), members, candidates);
    result.inclusion.push_back(inclusion_of(result.weights[m], result.substitutes[m]));
  }
  add_blurred_shapes(trials, result, candidates);
  add_late_shapes(trials, result, rivals, swaps, candidates.size());
}

/// What was refused is no alternative either.
void leave_out_refused(Conclusion& result, const std::vector<const Candidate*>& refused) {
  const auto is_refused = [&](const Candidate* c) { return is_among(refused, *c); };
  for (std::vector<Substitute>& list : result.substitutes)
    std::erase_if(list, [&](const Substitute& other) { return is_refused(other.candidate); });
  std::erase_if(result.other_sets,
                [&](const OtherSet& other) { return std::ranges::any_of(other.by, is_refused); });
}

/// Whether the errors are white and of one size, beside what the counts of the sensor make of them.
void judge_errors(const Trials& trials, Conclusion& result) {
  const Estimate& estimate = result.estimate;
  const Noise& noise = estimate.noise;
  const bool is_noisy = noise.white > 2 * criteria::least_white_noise * trials.force_rms;
  const double rows = double(fitted_numbers(trials)) / double(trials.ports());
  const double most_bursts = std::max(least_bursts, most_bursts_per_row * rows);
  if (estimate.members.empty() && noise.white > criteria::loud_noise * trials.force_rms)
    result.most_portmanteau = criteria::most_portmanteau_of_noise_seen;  // or something hides in the noise
  const double of_squares = portmanteau_of_squares(trials, *estimate.fitted);
  result.portmanteau = portmanteau(trials, *estimate.fitted);
  // Beside less noise the arithmetic of the diagram comes in bursts too.
  const bool matters = std::hypot(noise.white, noise.slow()) > least_excess * trials.force_rms;
  result.comes_in_bursts = matters && of_squares > most_bursts;
  if (result.portmanteau > most_portmanteau_of_counted || result.comes_in_bursts)
    if (const WhitenedErrors errors = errors_of_counts(trials, estimate); !errors.empty()) {
      if (is_noisy && estimate.members.empty())
        result.most_portmanteau = std::min(result.most_portmanteau, most_portmanteau_of_counted);
      result.counts_portmanteau = portmanteau_of_counts(trials, errors);
      result.comes_in_bursts &= of_squares - reach_of_counts * bursts_of_counts(trials, errors) > most_bursts;
    }
  result.trail.push_back(fmt::format(
      "portmanteau {:.0f}, of counts alone {:.0f}, of squares {:.0f}{}; noise: white {:.3g}, slow "
      "{:.3g} over {:.3g} rows, sensor {:.3g}",
      result.portmanteau, result.counts_portmanteau, of_squares, result.comes_in_bursts ? " (bursts)" : "",
      noise.white, noise.slow(), noise.memory_samples(), noise.measurement.front()));
}

/// Joint maximum likelihood, repeated with a simpler set that is as good, or at most `rounds` times with a
/// better one.
Conclusion concluded(Trials& trials, const std::vector<Candidate>& candidates,
                     const std::vector<Shape>& shapes, Estimate found, int rounds,
                     const std::vector<const Candidate*>& refused) {
  Conclusion result;
  Estimate& estimate = result.estimate;
  result.turn = trials.turn;
  estimate = snap_to_turn(trials, std::move(found));
  leave_out_doubtful(trials, estimate);
  estimate = fitted_in_flight(trials, std::move(estimate));
  const bool was_doubtful = may_be_doubtful(estimate.members);
  keep_material(trials, result, candidates.size());
  const bool are_rows_added = !has_dry_friction(estimate.members) && forget_reversals(trials);
  if ((was_doubtful && !may_be_doubtful(estimate.members)) || are_rows_added) {  // other rows count again
    leave_out_doubtful(trials, estimate);
    keep_material(trials, result, candidates.size());
  }
  for (size_t m = 0; m < estimate.members.size(); ++m)
    result.trail.push_back(fmt::format("kept: {}, χ² {:.0f} (of counts {:.0f})",
                                       estimate.members[m].candidate->name, result.weights[m].wald,
                                       result.weights[m].counts));
  judge_errors(trials, result);
  const Noise& noise = estimate.noise;
  const double n = double(fitted_numbers(trials));
  // A small force below 80 Hz says nothing about a faster one.
  const bool is_vibration =
      noise.white > criteria::negligible_force * trials.usual_force &&
      result.portmanteau_beside_counts() > criteria::most_portmanteau_per_row * n / double(trials.ports());
  result.is_negligible = !is_vibration && is_negligible(trials, estimate.members);
  const std::vector<Shape> periodic = periodic_shapes(trials, estimate, candidates, 1);
  std::vector<const Shape*> all;
  for (const auto* list : {&shapes, &periodic})
    for (const Shape& shape : *list)
      if (!is_among(refused, *shape.candidate)) all.push_back(&shape);
  Evidence evidence(trials, estimate, all, candidates.size());
  const std::vector<Proposal> exchanges = evidence.exchanges();
  FrictionAtReversals at_reversals(trials, estimate, shapes, candidates.size(), refused);
  Rivals rivals(
      trials, estimate, candidates.size(),
      std::max({least_gain, least_gain_per_row * n, unexplained(result.portmanteau_beside_counts())}),
      at_reversals, refused);
  std::optional<Estimate> instead;
  if (rounds > 0 && (instead = at_reversals.better()))
    result.trail.push_back("after reversals another law of dry friction does better");
  if (!instead) instead = named(trials, rivals, estimate.members, exchanges);
  if (!instead) instead = simplified(rivals, estimate.members, exchanges);
  if (!instead && (instead = same_law_by_fewer(trials, rivals, estimate.members, candidates)))
    result.trail.push_back("fewer members state the same law");
  SecondLook seen;
  if (!instead) {
    seen = look_again(trials, estimate, result.portmanteau_beside_counts(), evidence, candidates.size());
    std::ranges::copy(seen.trail, std::back_inserter(result.trail));
    if (rounds > 0 && (instead = std::move(seen.better)))
      result.trail.push_back("with the noise known, more is seen");
  }
  if (!instead) {
    ask_rivals(trials, result, evidence, exchanges, candidates, rivals, at_reversals, n);
    std::ranges::move(alike_in_one_direction(trials, estimate, candidates),
                      std::back_inserter(result.other_sets));
    leave_out_refused(result, refused);
    const auto doubt = [&](const Estimate& rival) { return unexplained_beside_counts(trials, rival); };
    if (rounds > 0 && (instead = rivals.better(doubt)))
      result.trail.push_back("with noise of its own another set does better");
    else if ((instead = without_uncertain_delay(trials, estimate, result.weights)))
      result.trail.push_back("with the noise known, a delay is not worth its parameter");
  }
  if (instead) {
    Conclusion next = concluded(trials, candidates, shapes, std::move(*instead), rounds - 1, refused);
    next.trail.insert(next.trail.begin(), result.trail.begin(), result.trail.end());
    return next;
  }
  widen_by_halves(trials, estimate);
  result.is_remainder_noise = is_remainder_noise(trials, *estimate.fitted, estimate.noise);
  result.too_small = std::move(seen.small);
  return result;
}

}  // namespace

Conclusion conclude(Trials& trials, const std::vector<Candidate>& candidates,
                    const std::vector<Shape>& shapes, Estimate found,
                    const std::vector<const Candidate*>& refused) {
  constexpr int rounds = 2;
  return concluded(trials, candidates, shapes, std::move(found), rounds, refused);
}

}  // namespace loopwright::diagnosis
