/// The part of a system that connects its inputs to its outputs.
#pragma once
#include "models/linear/state_space.h"

namespace loopwright {

/// The system without the states that no input reaches or that affect no output, by the sparsity pattern
/// alone. Blocks behind a disconnected wire are removed even if they are unstable, and no rank has to be
/// decided. The result is not always minimal.
StateSpace connected_part(const StateSpace& system);

}  // namespace loopwright
