/// Finds when a force jumps: all instants at once.
#pragma once
#include "tools/diagnose/search/evidence.h"

namespace loopwright::diagnosis {

/// Shapes of the candidates that jump at an instant, at those that the errors ask for most. Of several
/// records none: their clocks have nothing in common.
std::vector<Shape> jump_shapes(const Trials& trials, const Estimate& estimate,
                               const std::vector<Candidate>& candidates);

}  // namespace loopwright::diagnosis
