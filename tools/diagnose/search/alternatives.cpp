#include "tools/diagnose/search/alternatives.h"
#include "tools/diagnose/search/replacement.h"
#include "tools/diagnose/search/weight.h"
#include <algorithm>
#include <set>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/remaining_force.h"

namespace loopwright::diagnosis {
namespace {

void add_if_closer(std::vector<Substitute>& list, const Substitute& other) {
  const auto same = std::ranges::find(list, other.candidate, &Substitute::candidate);
  if (same == list.end())
    list.push_back(other);
  else
    same->loss = std::min(same->loss, other.loss);
}

}  // namespace

std::vector<Substitute> substitutes_of(Rivals& rivals, size_t member, const Candidate& present,
                                       const std::vector<Proposal>& exchanges, double nothing) {
  // What promises less could only be an alternative by louder noise, as nothing in that place could.
  constexpr double least_taken_over = 0.1;
  const double most_promised = std::max(rivals.reach() + error_of_promise, (1 - least_taken_over) * nothing);
  std::vector<Substitute> list;
  for (const Proposal& proposal : exchanges) {
    const bool is_one_for_one = proposal.removed == std::vector<size_t>{member} && proposal.added.size() == 1;
    if (!is_one_for_one || list.size() >= 3 || -proposal.gain > most_promised) continue;
    const auto loss = rivals.loss_of(proposal);
    const Candidate& other = *proposal.added.front().candidate;
    // The effect itself from another start may become the better rival, but is no other effect.
    if (loss && *loss < nothing && &other != &present) add_if_closer(list, {&other, *loss});
  }
  std::ranges::stable_sort(list, {}, &Substitute::loss);
  return list;
}

void add_if_new(std::vector<Substitute>& list, const Candidate* candidate) {
  if (std::ranges::find(list, candidate, &Substitute::candidate) == list.end())
    list.push_back({candidate, 0});
}

void add_other_late_inputs(std::vector<Substitute>& list, const std::vector<Member>& members,
                           const std::vector<Candidate>& candidates) {
  for (const Candidate& other : candidates)
    if (is_late_input(other) && std::ranges::find(members, &other, &Member::candidate) == members.end())
      add_if_new(list, &other);
}

void add_simpler_friction(std::vector<Substitute>& list, const Trials& trials, Rivals& rivals,
                          const Estimate& estimate, size_t member, const std::vector<Proposal>& exchanges) {
  const Candidate& shaped = *estimate.members[member].candidate;
  if (!trials.inverse || !is_dry_friction(shaped)) return;
  const auto is_simpler = [&](const Proposal& p) {
    if (p.removed != std::vector<size_t>{member} || p.added.size() != 1) return false;
    const Candidate& other = *p.added.front().candidate;
    return is_dry_friction(other) && parameters_of(other) < parameters_of(shaped);
  };
  const double left = residual_size(trials, *trials.inverse, estimate.members).fitted;
  for (const Proposal& proposal : exchanges) {
    if (!is_simpler(proposal) || rivals.is_spent()) continue;
    const Estimate other = rivals.fitted(proposal);
    if (!other.is_valid) continue;
    const double with_other = residual_size(trials, *trials.inverse, other.members).fitted;
    if (with_other <= criteria::same_balance * left && !rivals.is_refuted(proposal, other))
      add_if_new(list, proposal.added.front().candidate);
  }
}

std::vector<OtherSet> other_sets(Rivals& rivals, const std::vector<Member>& members,
                                 const std::vector<Proposal>& proposals) {
  constexpr size_t most_tried = 5, most_told = 3;
  std::vector<OtherSet> list;
  std::set<std::multiset<std::string>> tried;
  for (const Proposal& proposal : proposals) {
    if (tried.size() >= most_tried) break;
    OtherSet other;
    std::multiset<std::string> names;
    for (size_t m : proposal.removed) other.replaced.push_back(members[m].candidate);
    for (const Member& m : proposal.added) other.by.push_back(m.candidate), names.insert(m.candidate->name);
    const bool is_one_for_one = other.replaced.size() == 1 && other.by.size() == 1;
    const bool comes_back = std::ranges::any_of(
        other.replaced, [&](const Candidate* c) { return names.contains(c->name) || c->is_unknown; });
    for (const Candidate* c : other.replaced) names.insert("without " + c->name);
    if (is_one_for_one || comes_back || !tried.insert(names).second) continue;
    if (const auto loss = rivals.loss_of(proposal)) other.loss = *loss, list.push_back(std::move(other));
  }
  std::ranges::stable_sort(list, {}, &OtherSet::loss);
  if (list.size() > most_told) list.resize(most_told);
  return list;
}

namespace {

/// What the first has and the second has not.
std::vector<const Candidate*> without(std::vector<const Candidate*> list,
                                      const std::vector<const Candidate*>& others) {
  for (const Candidate* other : others)
    if (const auto at = std::ranges::find(list, other); at != list.end()) list.erase(at);
  return list;
}

bool is_of_one(const OtherSet& set) { return set.replaced.size() == 1 && set.by.size() == 1; }

}  // namespace

std::vector<OtherSet> other_sets_of_laws(Rivals& rivals, const std::vector<Member>& members,
                                         const std::vector<Proposal>& proposals) {
  constexpr size_t most_tried = 3;
  std::vector<OtherSet> list;
  size_t tried = 0;
  for (const Proposal& proposal : proposals) {
    if (tried >= most_tried || rivals.is_spent()) break;
    std::vector<const Candidate*> before, now;
    for (size_t m : proposal.removed) before.push_back(members[m].candidate);
    for (const Member& m : proposal.added) now.push_back(m.candidate);
    OtherSet other{without(before, now), without(now, before)};
    // That a member is not needed is known; which dry friction it is, is seen after reversals.
    const bool is_other_friction =
        is_of_one(other) && is_dry_friction(*other.replaced.front()) && is_dry_friction(*other.by.front());
    const bool has_no_name = std::ranges::any_of(other.replaced, &Candidate::is_unknown);
    if (other.by.empty() != other.replaced.empty() || is_other_friction || has_no_name) continue;
    ++tried;
    const auto loss = rivals.loss_of(proposal);
    const bool is_same = other.by.empty();  // with other shapes, which may be better
    if (loss && !is_same) other.loss = *loss, list.push_back(std::move(other));
  }
  return list;
}

void add_laws(const std::vector<OtherSet>& laws, const Candidate& member, double nothing,
              std::vector<Substitute>& substitutes) {
  for (const OtherSet& law : laws)
    if (is_of_one(law) && law.replaced.front() == &member && law.loss < nothing)
      add_if_closer(substitutes, {law.by.front(), law.loss});
  std::ranges::stable_sort(substitutes, {}, &Substitute::loss);
}

void add_laws(const std::vector<OtherSet>& laws, std::vector<OtherSet>& sets) {
  for (const OtherSet& law : laws) {
    const auto is_same = [&](const OtherSet& set) {
      return set.replaced == law.replaced && set.by == law.by;
    };
    if (!is_of_one(law) && std::ranges::none_of(sets, is_same)) sets.push_back(law);
  }
  std::ranges::stable_sort(sets, {}, &OtherSet::loss);
}

namespace {

/// With usual shapes, and no force yet, unless its amplitude is one.
Member at_start(const Candidate& candidate) {
  Member member{&candidate, std::vector<double>(candidate.linear.size(), 0.0), {}};
  if (candidate.amplitude_is_one) member.linear = {1};
  for (const CandidateParameter& p : candidate.nonlinear) member.nonlinear.push_back(p.start);
  return member;
}

}  // namespace

Estimate in_place_of(Trials& trials, const Estimate& estimate, size_t member,
                     const std::vector<Substitute>& substitutes, const std::vector<const Candidate*>& refused,
                     size_t catalogue) {
  constexpr int iterations = 8;
  const auto fitted = [&](std::vector<Member> members) {
    return fit_members(trials, std::move(members), estimate.noise, estimate.motion, iterations);
  };
  Estimate best = fitted(without_one(estimate.members, member));
  for (const Substitute& other : substitutes) {
    if (is_among(refused, *other.candidate)) continue;
    std::vector<Member> members = estimate.members;
    members[member] = at_start(*other.candidate);
    Estimate trial = fitted(std::move(members));
    if (trial.is_valid && criterion(trials, trial, catalogue) < criterion(trials, best, catalogue))
      best = std::move(trial);
  }
  return best;
}

}  // namespace loopwright::diagnosis
