/// Where along the axis the errors repeat: every pitch at once.
#pragma once
#include "tools/diagnose/evidence.h"

namespace loopwright::diagnosis {

/// Shapes of every periodic candidate at the pitches that stand out of the errors' spatial spectrum, and at
/// the pitches that members already have, so that each of them can be held against the others of its kind.
std::vector<Shape> periodic_shapes(const Trials& trials, const Estimate& estimate,
                                   const std::vector<Candidate>& candidates, size_t lines = 3);

}  // namespace loopwright::diagnosis
