/// Gaps in which a load may fly. When it crosses one, and so where the likelihood has a maximum, changes with
/// every gap: a fit reaches the next of them only.
#pragma once
#include "tools/diagnose/search/evidence.h"

namespace loopwright::diagnosis {

/// Loads in gaps in the place of loads on springs, with their resonances: the best few of a grid of gaps.
/// Between its blows such a load swings on its flank as one on a spring does.
std::vector<Proposal> gaps_for_springs(const Trials& trials, const Estimate& estimate,
                                       const std::vector<Candidate>& candidates);

/// The members with other gaps of the load `load`: the best few of a grid of gaps, according to what the
/// members leave that are found without it.
std::vector<std::vector<Member>> other_gaps(Trials& trials, const Estimate& estimate, size_t load);

}  // namespace loopwright::diagnosis
