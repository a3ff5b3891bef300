/// How wide every port is.
#pragma once
#include "engine/plan/flatten.h"

namespace loopwright {

/// Works out FlatBlock::width and output_lengths from the wires; clashes are problems.
void find_shapes(FlatDiagram& flat, Problems& problems);

/// Elements that a wire carries.
int length_of(const FlatDiagram& flat, const FlatWire& wire);

}  // namespace loopwright
