/// Unnamed forces: any smooth function of a few variables, for effects that the catalogue does not contain.
#pragma once
#include "tools/diagnose/search/candidate.h"
#include "tools/effects/effect.h"

namespace loopwright::diagnosis {

/// Functions of position, of velocity, of time, of position with the direction (a position-dependent dry
/// friction), with the velocity (a position-dependent damping) or with the acceleration (a position-dependent
/// mass), and a tone in time. `form` lists the variables, separated by commas. For a map of balances, only
/// position and direction.
std::vector<Candidate> unknown_forces(const RecordSizes& sizes, bool is_map);

}  // namespace loopwright::diagnosis
