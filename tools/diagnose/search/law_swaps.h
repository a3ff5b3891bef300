/// Gain, mass and damping: three numbers of which a law of motion determines only two.
#pragma once
#include "tools/diagnose/search/evidence.h"

namespace loopwright::diagnosis {

/// (1 + g) u = (M + m) a + (B + b) v + F is the same law when it is divided by a number: a gain is equivalent
/// to mass and damping, and mass and damping to a gain. One of g, m and b is removed and another one
/// inserted, and all forces are divided. This change is too large for a linearization to find. Of records
/// with masses M of their own the law is not the same: the mean of them is where a fit may begin.
std::vector<Proposal> law_swaps(const std::vector<Member>& members, const std::vector<Candidate>& candidates,
                                const Trials& trials);

/// The effect of the catalogue that is a gain.
constexpr std::string_view gain_name = "force_gain";
/// Whether a gain is among the members.
bool has_gain(const std::vector<Member>& members);

/// Preference for a set over another one, in addition to its criterion: of two sets of equal size that state
/// the same law, the one without a gain is preferred, because a mass and a friction are more often inaccurate
/// than a motor constant. None among records of different masses or dampings, which tell them apart.
double preference(const Trials& trials, const std::vector<Member>& members, const std::vector<Member>& other);

}  // namespace loopwright::diagnosis
