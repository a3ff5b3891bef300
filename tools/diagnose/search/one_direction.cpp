#include "tools/diagnose/search/one_direction.h"
#include <algorithm>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/evidence.h"
#include "tools/diagnose/search/names.h"
#include "tools/diagnose/search/weight.h"

namespace loopwright::diagnosis {
namespace {

/// A level far below every force: what it does is linear, and bends nothing.
constexpr double probe = 1e-3;  // [driving force]

}  // namespace

bool goes_one_way(const Trials& trials, const Estimate& estimate) {
  size_t forward = 0, backward = 0;
  for (size_t t = 0; t < trials.list.size(); ++t) {
    const Trial& trial = trials.list[t];
    const Path& path = *estimate.motion.paths[t];
    for (size_t k = 0; k < std::min(trial.held_out_from, path.samples()); ++k)
      if (trial.usable[k]) ++(path.velocity[k] > 0 ? forward : backward);
  }
  return forward == 0 || backward == 0;
}

namespace {

/// A set with a little of a force beside it.
Estimate with_little(Trials& trials, const Estimate& estimate, std::vector<Member> members,
                     const Candidate& force) {
  Member little{&force, {probe * trials.force_rms}, {}};
  for (const CandidateParameter& shape : force.nonlinear) little.nonlinear.push_back(shape.start);
  members.push_back(std::move(little));
  return fit_members(trials, std::move(members), estimate.noise, estimate.motion, 0);
}

/// Whether the others do all that the last member does.
bool is_contained(Trials& trials, Estimate& set) {
  if (!set.is_valid || set.against_at_rest > criteria::least_gain) return false;
  const Weight last = weigh_all(trials, set).back();
  return last.unique_force < criteria::share_beside_constant * last.force_rms;
}

/// Whether it is this member that does it.
bool contains(Trials& trials, const Estimate& estimate, size_t member, const Candidate& force) {
  Estimate without = with_little(trials, estimate, without_one(estimate.members, member), force);
  return without.is_valid && !is_contained(trials, without);
}

/// Dry friction of one level, or a force that is the same everywhere.
bool may_pull_evenly(const Candidate& candidate) {
  return candidate.acts == Acts::force && candidate.linear.size() == 1 &&
         (is_dry_friction(candidate) || candidate.nonlinear.empty());
}

}  // namespace

std::vector<OtherSet> alike_in_one_direction(Trials& trials, const Estimate& estimate,
                                             const std::vector<Candidate>& candidates) {
  const std::vector<Member>& members = estimate.members;
  std::vector<OtherSet> sets;
  if (members.empty() || trials.has_map() || has_function_without_name(members) ||
      !goes_one_way(trials, estimate))
    return sets;
  for (const Candidate& other : candidates) {
    const bool is_present = std::ranges::find(members, &other, &Member::candidate) != members.end();
    const bool is_friction = is_dry_friction(other);
    if (is_present || !may_pull_evenly(other)) continue;
    if (is_friction && (trials.nominal_holds || has_dry_friction(members))) continue;
    Estimate with = with_little(trials, estimate, members, other);
    if (!is_contained(trials, with)) continue;
    for (size_t m = 0; m < members.size(); ++m)
      if (const Candidate* present = members[m].candidate;
          is_dry_friction(*present) != is_friction && contains(trials, estimate, m, other))
        sets.push_back({{present}, {present, &other}, 0});
  }
  return sets;
}

}  // namespace loopwright::diagnosis
