/// What takes the place of an effect that does not stand.
#pragma once
#include "tools/diagnose/search/alternatives.h"

namespace loopwright::diagnosis {

/// The estimate without a member, or with one of its substitutes in its place: where all motion goes one way,
/// drag does what a friction does that differs with the direction. Without it, all that it explained would
/// become noise, in which the others no longer count.
Estimate in_place_of(Trials& trials, const Estimate& estimate, size_t member,
                     const std::vector<Substitute>& substitutes, const std::vector<const Candidate*>& refused,
                     size_t catalogue);

}  // namespace loopwright::diagnosis
