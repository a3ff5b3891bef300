/// The vector lengths of all ports.
#pragma once
#include "engine/plan/flatten.h"

namespace loopwright {

/// Computes FlatBlock::width and output_lengths from the wires; contradictions are problems.
void find_shapes(FlatDiagram& flat, Problems& problems);

/// Number of elements of a wire.
int length_of(const FlatDiagram& flat, const FlatWire& wire);

}  // namespace loopwright
