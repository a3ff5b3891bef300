/// Gain, mass and damping: three numbers of which a law of motion has but two.
#pragma once
#include "tools/diagnose/evidence.h"

namespace loopwright::diagnosis {

/// (1 + g) u = (M + m) a + (B + b) v + F is the same law when all of it is divided by a number: a gain stands
/// for mass and damping, mass and damping for a gain. One of g, m and b is taken out and another put in, and
/// all forces are divided: too far for a linearization to find.
std::vector<Proposal> law_swaps(const std::vector<Member>& members, const std::vector<Candidate>& candidates,
                                const AxisModel& model);

/// Whether a gain is among the members.
bool has_gain(const std::vector<Member>& members);

/// What speaks for a set beside its criterion, against another one: of two of a size that state the same law
/// the one without a gain is preferred, as a mass and a friction are more often known badly than a motor.
double preference(const std::vector<Member>& members, const std::vector<Member>& other);

}  // namespace loopwright::diagnosis
