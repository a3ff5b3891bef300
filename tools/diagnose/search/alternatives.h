/// What the answer declares beside its members: other candidates and sets that explain the records as well.
#pragma once
#include "tools/diagnose/search/rivals.h"

namespace loopwright::diagnosis {

struct Substitute {
  const Candidate* candidate = nullptr;
  double loss = 0;  ///< how much worse the criterion is with it; negative: better
};

/// Members that others could jointly replace, two for one or two or one for two.
struct OtherSet {
  std::vector<const Candidate*> replaced, by;
  double loss = 0;  ///< how much worse the criterion is with it
};

/// Laws of one variable that do as well together, told by what differs from those that are there.
std::vector<OtherSet> other_sets_of_laws(Rivals& rivals, const std::vector<Member>& members,
                                         const std::vector<Proposal>& proposals);
/// Those that exchange a single member go to its alternatives, as long as they explain something, the others
/// to the sets.
void add_laws(const std::vector<OtherSet>& laws, const Candidate& member, double nothing,
              std::vector<Substitute>& substitutes);
void add_laws(const std::vector<OtherSet>& laws, std::vector<OtherSet>& sets);

void add_if_new(std::vector<Substitute>& list, const Candidate* candidate);

/// A delay for a lag, or a lag for a delay, of a set that has only one of them.
void add_other_late_inputs(std::vector<Substitute>& list, const std::vector<Member>& members,
                           const std::vector<Candidate>& candidates);

/// [-2 ln L] Far from its operating point the loss that a linearization promises may be wrong by so much.
inline constexpr double error_of_promise = 100;

/// Alternatives: every other candidate in place of a member, with its shape and all parameters fitted. One
/// that several proposals begin with counts once. `nothing`: what the criterion loses with nothing in its
/// place; an alternative explains something.
std::vector<Substitute> substitutes_of(Rivals& rivals, size_t member, const Candidate& present,
                                       const std::vector<Proposal>& exchanges, double nothing);

/// Dry friction with a shape, where simpler dry friction leaves no more force along the smooth motion: only
/// the moments after a breakaway speak for the shape, and these also depend on when exactly it happened.
void add_simpler_friction(std::vector<Substitute>& list, const Trials& trials, Rivals& rivals,
                          const Estimate& estimate, size_t member, const std::vector<Proposal>& exchanges);

/// The same for several members at a time; the most promising are tried.
std::vector<OtherSet> other_sets(Rivals& rivals, const std::vector<Member>& members,
                                 const std::vector<Proposal>& proposals);

}  // namespace loopwright::diagnosis
