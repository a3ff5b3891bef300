/// Finds where along the axis the errors repeat: all pitches at once.
#pragma once
#include "tools/diagnose/search/evidence.h"

namespace loopwright::diagnosis {

/// Shapes of every periodic candidate at the peaks of the errors' spatial spectrum, and at the pitches of the
/// present members, so that each member can be compared with the other candidates of its kind.
std::vector<Shape> periodic_shapes(const Trials& trials, const Estimate& estimate,
                                   const std::vector<Candidate>& candidates, size_t lines = 3);

}  // namespace loopwright::diagnosis
