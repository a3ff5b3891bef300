/// What of a system lies between its inputs and its outputs at all.
#pragma once
#include "models/linear/state_space.h"

namespace loopwright {

/// The system without states that no input reaches or that no output sees, by the pattern of its matrices
/// alone: blocks behind a cut wire go, however unstable, and no rank has to be decided. Not always minimal.
StateSpace connected_part(const StateSpace& system);

}  // namespace loopwright
