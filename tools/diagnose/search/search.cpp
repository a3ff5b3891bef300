#include "tools/diagnose/search/search_steps.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <ranges>
#include "tools/diagnose/search/conclude.h"
#include "tools/diagnose/search/doubt.h"
#include "tools/diagnose/search/flights.h"
#include "tools/diagnose/search/jumps.h"
#include "tools/diagnose/search/law_swaps.h"
#include "tools/diagnose/search/laws_of_one_variable.h"
#include "tools/diagnose/search/merged_rows.h"
#include "tools/diagnose/search/names.h"
#include "tools/diagnose/search/other_starts.h"
#include "tools/diagnose/search/prune.h"
#include "tools/diagnose/search/remaining_force.h"
#include "tools/diagnose/search/shape_swaps.h"
#include "tools/diagnose/search/spectrum.h"
#include "tools/diagnose/search/whiteness.h"

namespace loopwright::diagnosis {
namespace {

constexpr size_t most_effects = 8, tried_extensions = 4, tried_exchanges = 3;
/// A map shows a motor's lines one by one, and little else. Functions of position without a name, which can
/// stand for any long line, come after all of them.
constexpr size_t most_steps_in_a_map = 16;

/// The same candidates, whose shapes are no further apart than a fit reaches.
bool are_near(const std::vector<Member>& one, const std::vector<Member>& other) {
  return one.size() == other.size() && std::ranges::all_of(one, [&](const Member& member) {
           return std::ranges::any_of(other, [&](const Member& m) {
             return m.candidate == member.candidate && !is_far(m.nonlinear, member.nonlinear);
           });
         });
}

}  // namespace

Search::Search(Trials& trials, const std::vector<Candidate>& candidates, const std::vector<Shape>& shapes,
               const std::vector<Candidate>& unknown, const Motion& motion)
    : unknown_(unknown),
      trials_(trials),
      candidates_(candidates),
      shapes_(shapes),
      noise_(search_noise(trials)),
      motion_(motion) {
  take(fit_members(trials_, {}, noise_, motion_, 0));
}

SearchResult Search::run() {
  bool goes_on = grow(4);
  if (!goes_on && is_much_left() && rest_is_noise()) goes_on = grow(4);
  if (goes_on && is_much_left() && trials_.has_map()) goes_on = grow(most_steps_in_a_map);
  if (!is_spent() && (is_much_left() || explain_without_name())) goes_on = !start_from_what_has_no_name();
  if (goes_on) grow(most_effects - std::min(most_effects, best_.members.size()));
  if (auto function = function_of_velocity(trials_, best_, unknown_, candidates_.size(), trail_))
    take_nameless(std::move(*function));
  return {std::move(best_), std::move(trail_)};
}

SearchResult Search::run_on(const std::vector<Member>& members) {
  most_work_ = trials_.work->share() + criteria::work_going_on;
  take(refined(members, 4));
  note("searched on");
  constexpr size_t most = 4;
  for (size_t step = 0; step < most && best_.is_valid; ++step) {
    const Estimate before = best_;
    if (!grow(1) || promised_mean_square(before, most - step - 1) >= criteria::much_left) break;
  }
  return {std::move(best_), std::move(trail_)};
}

double Search::mean_square_now(const Estimate& e) const {
  return fit_members(trials_, e.members, noise_, e.motion, 0).mean_square;
}

double Search::promised_mean_square(const Estimate& before, size_t further) const {
  return best_.mean_square * std::pow(best_.mean_square / mean_square_now(before), further);
}

Estimate Search::refined(const std::vector<Member>& members, int iterations) {
  return fit_members(trials_, members, noise_, best_.motion, iterations);
}

void Search::note(const char* what) {
  trail_.push_back(described(what, best_, score(best_)));
  if (trials_.found) trials_.found(best_.members);
}

void Search::take(Estimate better) {
  best_ = std::move(better), evidence_.reset();
  leave_out_doubtful(trials_, best_);
}

double Search::worth_of_names(const std::vector<Member>& members) const {
  return worth_losing_names(trials_) *
         (int(has_function_without_name(best_.members)) - int(has_function_without_name(members)));
}

double Search::gain_of(Estimate& trial) {
  if (!trial.is_valid) return -std::numeric_limits<double>::infinity();
  const double named = worth_of_names(trial.members);
  if (!may_be_doubtful(trial.members) || may_be_doubtful(best_.members))
    return named + score(best_) - score(trial);
  // Without the rows that are doubtful for the trial, both may differ.
  leave_out_doubtful(trials_, trial);
  trial = refined_further(trial), leave_out_doubtful(trials_, trial);
  trial = refined_further(trial);
  const double gain = named + score(refined_further(best_)) - score(trial);
  leave_out_doubtful(trials_, best_);
  return gain;
}

std::vector<const Shape*> Search::all_shapes() {
  timed_ = periodic_shapes(trials_, best_, candidates_);
  std::ranges::move(jump_shapes(trials_, best_, unknown_), std::back_inserter(timed_));
  std::vector<const Shape*> list;
  for (const Shape& shape : shapes_) list.push_back(&shape);
  for (const Shape& shape : timed_) list.push_back(&shape);
  return list;
}

Evidence& Search::evidence() {
  if (!evidence_) evidence_.emplace(trials_, best_, all_shapes(), candidates_.size());
  return *evidence_;
}

Estimate Search::first_fit(const Proposal& proposal) {
  const std::vector<Member> members = applied(proposal, best_.members);
  const double whole = trials_.list.front().model->nominal_inertia();
  const auto starts = is_much_left() ? std::vector<std::vector<Member>>{} : starts_of_load(members, whole);
  Estimate best = refined(members, starts.empty() ? 2 : 1);
  for (const std::vector<Member>& start : starts)
    if (Estimate trial = refined(start, 1);
        trial.is_valid && (!best.is_valid || trial.profile < best.profile))
      best = std::move(trial);
  return starts.empty() ? best : refined(best.members, 6);
}

bool Search::grow(size_t most) {
  for (size_t step = 0; step < most && !is_spent(); ++step) {
    if (!extend() && !exchange_laws()) return false;
    sharpen_noise();
    if (exchange()) sharpen_noise();
    prune();
  }
  return true;
}

bool Search::extend() {
  std::vector<Proposal> proposals = evidence().extensions();
  for (Proposal& proposal : proposals)
    if (has_function_without_name(proposal.added)) proposal.gain += worth_of_names(proposal.added);
  std::ranges::stable_sort(proposals, std::ranges::greater{}, &Proposal::gain);
  note(proposals);
  const double single = proposals.empty() ? 0 : proposals.front().gain;
  if (proposals.size() > tried_extensions) proposals.resize(tried_extensions);
  if (const std::optional<Proposal> pair = evidence().best_pair(); pair && pair->gain > single + 10) {
    if (pair->gain > 2 * single) proposals.resize(std::min<size_t>(proposals.size(), 2));
    proposals.push_back(*pair);
  }
  const double least = std::max(criteria::least_gain, criteria::least_gain_per_row * judged_numbers(trials_));
  std::vector<std::pair<double, Estimate>> tried;
  for (const Proposal& proposal : proposals) {
    Estimate trial = first_fit(proposal);
    const double gain = gain_of(trial);
    trail_.push_back(fmt::format("tried {}: criterion {:+.1f}", names_of(proposal.added), -gain));
    if (gain > least) tried.emplace_back(gain, std::move(trial));
  }
  std::ranges::stable_sort(tried, std::ranges::greater{}, [](const auto& t) { return t.first; });
  Estimate best;
  for (auto& [gain, trial] : tried)
    if (!best.is_valid && adds_material(trial)) best = std::move(trial);
  if (!best.is_valid) return note("no extension"), false;
  take(snap_to_turn(trials_, fit_members(trials_, best.members, noise_, best.motion, 6)));
  note("extended");
  leave_narrow_maximum();
  return true;
}

void Search::leave_narrow_maximum() {
  if (best_.mean_square < criteria::well_explained) return;
  for (const std::vector<Member>& start : starts_of_hysteresis(best_.members)) {
    Estimate trial = refined(start, 6);
    if (!trial.is_valid || score(best_) - score(trial) < criteria::clearly_better) continue;
    take(std::move(trial));
    note("from another start");
  }
}

bool Search::adds_material(Estimate& trial) {
  leave_out_doubtful(trials_, trial);
  const std::vector<Weight> weights = weigh_all(trials_, trial);
  leave_out_doubtful(trials_, best_);
  for (size_t m = best_.members.size(); m < weights.size(); ++m) {
    const Weight& w = weights[m];
    const Member& member = trial.members[m];
    if (member.candidate->acts == Acts::input && is_at_limit(member)) {
      trail_.push_back("at the end of its range, where it stands for something else: " +
                       member.candidate->name);
      return false;
    }
    if (is_feigned_within_rows(trials_, trial, m, w)) {
      trail_.push_back("an answer to noise within a row that stands for several: " + member.candidate->name);
      return false;
    }
    const bool spoils = spoils_balance(trials_, trial, m, w);
    if (material(trials_, trial, w) >= 1 && !spoils) continue;
    if (spoils) {
      trail_.push_back("spoils the balance of the forces: " + trial.members[m].candidate->name);
      return false;
    }
    trail_.push_back(fmt::format("not material: {}, χ² {:.0f}, force {:.3g}, unique {:.3g}",
                                 trial.members[m].candidate->name, w.wald, w.force_rms, w.unique_force));
    return false;
  }
  return true;
}

bool Search::exchange_laws() {
  bool any = false;
  for (const LawOf variable : {LawOf::velocity, LawOf::position}) {
    if (is_spent()) return any;
    double gain = criteria::clearly_better;
    Estimate better = best_of(with_other_laws(trials_, best_, candidates_, variable), gain);
    if (!better.is_valid) continue;
    take(std::move(better)), any = true;
    note("with other laws");
  }
  return any;
}

Estimate Search::best_of(const std::vector<std::vector<Member>>& others, double& best_gain) {
  Estimate best;
  for (const std::vector<Member>& members : others) {
    Estimate trial = pruned(trials_, refined(members, 4), noise_, candidates_.size());
    const double gain = gain_of(trial);
    trail_.push_back(fmt::format("tried instead {}: criterion {:+.1f}", names_of(members), -gain));
    const double preferred = gain + preference(trials_, trial.members, best_.members);
    if (preferred > best_gain) best_gain = preferred, best = std::move(trial);
  }
  return best;
}

bool Search::exchange() {
  bool any = false;
  for (int round = 0; round < 4; ++round) {
    if (best_.members.empty() || is_spent()) return any;
    const std::vector<Proposal> proposals = evidence().exchanges();
    std::vector<std::vector<Member>> others;
    for (const Proposal& swap : shape_swaps(best_.members, candidates_))
      others.push_back(applied(swap, best_.members));
    if (has_gain(best_.members))
      for (const Proposal& swap : law_swaps(best_.members, candidates_, trials_))
        others.push_back(applied(swap, best_.members));
    for (size_t i = 0; i < std::min(tried_exchanges, proposals.size()); ++i)
      if (proposals[i].gain >= -0.01 * evidence().rows())
        add_if_other(others, applied(proposals[i], best_.members));
    double best_gain = criteria::clearly_better;
    Estimate best = best_of(others, best_gain);
    if (!best.is_valid) return any;
    if (best.members.size() > best_.members.size() && is_surpassed_by_extension(best_gain)) return any;
    const bool goes_on_to_fit = are_near(best.members, best_.members);
    take(std::move(best)), any = true;
    note("exchanged");
    if (goes_on_to_fit) return any;
  }
  return any;
}

bool Search::is_surpassed_by_extension(double gain) {
  std::vector<Proposal> proposals = evidence().extensions();
  if (proposals.size() > 2) proposals.resize(2);
  return std::ranges::any_of(proposals, [&](const Proposal& proposal) {
    Estimate trial = refined(applied(proposal, best_.members), 4);
    return trial.is_valid && gain_of(trial) > gain && adds_material(trial);
  });
}

void Search::prune() {
  Estimate left = pruned(trials_, best_, noise_, candidates_.size());
  if (left.members.size() == best_.members.size()) return;
  take(std::move(left));
  note("removed");
}

void Search::sharpen_noise() {
  if (is_much_left()) return;
  noise_ = fit_noise_alone(trials_, *best_.fitted, noise_, FreeNoise::white_and_slow);
  take(fit_members(trials_, best_.members, noise_, best_.motion, 2));
  trail_.push_back(fmt::format("noise: white {:.3g}, slow {:.3g}", noise_.white, noise_.slow()));
}

bool Search::rest_is_noise() {
  const Noise louder = fit_noise_alone(trials_, *best_.fitted, noise_, FreeNoise::white_and_slow);
  Estimate trial = fit_members(trials_, best_.members, louder, best_.motion, 4);
  if (!trial.is_valid || portmanteau(trials_, *trial.fitted) > criteria::most_portmanteau_of_search)
    return false;
  noise_ = louder, take(std::move(trial));
  note("with louder noise");
  prune();
  return true;
}

SearchResult search(Trials& trials, const std::vector<Candidate>& candidates,
                    const std::vector<Shape>& shapes, const std::vector<Candidate>& unknown,
                    const Motion& motion) {
  const WithoutFlights without(trials);
  return Search(trials, candidates, shapes, unknown, motion).run();
}

SearchResult search_on(Trials& trials, const std::vector<Candidate>& candidates,
                       const std::vector<Shape>& shapes, const std::vector<Candidate>& unknown,
                       const Motion& motion, const std::vector<Member>& members) {
  const WithoutFlights without(trials);
  return Search(trials, candidates, shapes, unknown, motion).run_on(members);
}

}  // namespace loopwright::diagnosis
