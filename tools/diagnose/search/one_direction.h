/// Constant forces and dry friction where all motion goes one way.
#pragma once
#include "tools/diagnose/search/conclude.h"

namespace loopwright::diagnosis {

/// Whether all rows that count move in one direction.
bool goes_one_way(const Trials& trials, const Estimate& estimate);

/// While an axis moves in one direction alone, dry friction pulls as a constant force does, and as the
/// preload of a spring: one that is found contains the other. For each such member, the same member with the
/// other one beside it. None if the motion goes both ways, or the rows at rest speak against the friction.
std::vector<OtherSet> alike_in_one_direction(Trials& trials, const Estimate& estimate,
                                             const std::vector<Candidate>& candidates);

}  // namespace loopwright::diagnosis
