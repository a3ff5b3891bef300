/// Where the fit of an effect begins anew, because from its first values it may end beside the best ones.
#pragma once
#include "tools/diagnose/search/candidate.h"

namespace loopwright::diagnosis {

/// Other values for the last member, if it is a load on a spring; empty: it is none. Along a motion that does
/// not show how the load pushes back, it seems to swing as both bodies do together, at ω / √(1 - m / M) of a
/// load m with the frequency ω in a machine of the mass M, and to be lighter than it is.
std::vector<std::vector<Member>> starts_of_load(const std::vector<Member>& members, double machine_mass);

/// Shorter and longer shapes of each friction that yields at rest. How far back it remembers has narrow
/// maxima of the likelihood beside the true one, because every reversal begins anew where the last one ended.
std::vector<std::vector<Member>> starts_of_hysteresis(const std::vector<Member>& members);

}  // namespace loopwright::diagnosis
