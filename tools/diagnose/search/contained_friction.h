/// Dry friction that the free constant of another effect contains.
#pragma once
#include "tools/diagnose/search/conclude.h"

namespace loopwright::diagnosis {

/// Where all motion goes one way, the preload of a spring pulls as Coulomb friction does, and takes its place
/// in every fit. For each member with such a constant: the same member with friction beside it. None if
/// something in the set holds already, or the rows at rest show that nothing does.
std::vector<OtherSet> friction_in_constants(Trials& trials, const Estimate& estimate,
                                            const std::vector<Candidate>& candidates);

}  // namespace loopwright::diagnosis
