/// Where the fit of a load on a spring begins.
#pragma once
#include "tools/diagnose/search/candidate.h"

namespace loopwright::diagnosis {

/// Other values for the last member, if it is a load on a spring; empty: it is none. Along a motion that does
/// not show how the load pushes back, it seems to swing as both bodies do together, at ω / √(1 - m / M) of a
/// load m with the frequency ω in a machine of the mass M, and to be lighter than it is.
std::vector<std::vector<Member>> starts_of_load(const std::vector<Member>& members, double machine_mass);

}  // namespace loopwright::diagnosis
