/// Forces without a name: any smooth function of a few variables, for what the catalogue does not hold.
#pragma once
#include "tools/diagnose/candidate.h"
#include "tools/effects/effect.h"

namespace loopwright::diagnosis {

/// Functions of position, of velocity, of time, of position with the direction (an uneven dry friction), with
/// the velocity (an uneven damping) or with the acceleration (an uneven mass), and a tone in time. `form`
/// lists the variables, separated by commas.
/// A map of balances has position and direction alone.
std::vector<Candidate> unknown_forces(const RecordSizes& sizes, bool is_map);

}  // namespace loopwright::diagnosis
