#include "tools/diagnose/search/contained_friction.h"
#include <algorithm>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/evidence.h"
#include "tools/diagnose/search/weight.h"

namespace loopwright::diagnosis {
namespace {

/// A level far below every force: what it does is linear, and bends nothing.
constexpr double probe = 1e-3;  // [driving force]

/// A set with friction of a small level beside it.
Estimate with_friction(Trials& trials, const Estimate& estimate, std::vector<Member> members,
                       const Candidate& friction) {
  members.push_back({&friction, {probe * trials.force_rms}, {}});
  return fit_members(trials, std::move(members), estimate.noise, estimate.motion, 0);
}

bool is_contained(Trials& trials, Estimate& with_friction) {
  const Weight friction = weigh_all(trials, with_friction).back();
  return friction.unique_force < criteria::share_beside_constant * friction.force_rms;
}

bool holds(const Member& member) {
  return member.candidate->is_unknown || member.candidate->at_rest != AtRest::free;
}

}  // namespace

std::vector<OtherSet> friction_in_constants(Trials& trials, const Estimate& estimate,
                                            const std::vector<Candidate>& candidates) {
  const auto friction = std::ranges::find_if(
      candidates, [](const Candidate& c) { return is_dry_friction(c) && parameters_of(c) == 1; });
  const std::vector<Member>& members = estimate.members;
  if (friction == candidates.end() || members.empty() || trials.nominal_holds || trials.has_map() ||
      std::ranges::any_of(members, holds))
    return {};
  Estimate with = with_friction(trials, estimate, members, *friction);
  if (!with.is_valid || with.against_at_rest > criteria::least_gain || !is_contained(trials, with)) return {};
  std::vector<OtherSet> sets;
  for (size_t m = 0; m < members.size(); ++m) {
    const Candidate& present = *members[m].candidate;
    if (parameters_of(present) == 1) continue;  // by itself a constant: friction stands in its place
    Estimate without = with_friction(trials, estimate, without_one(members, m), *friction);
    if (without.is_valid && !is_contained(trials, without))
      sets.push_back({{&present}, {&present, &*friction}, 0});
  }
  return sets;
}

}  // namespace loopwright::diagnosis
