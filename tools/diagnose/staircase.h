/// The effects in the order of their weight, and the error after each: the story that a reader follows. The
/// order in which the search met them is not shown; it is often a wrong one.
#pragma once
#include "tools/diagnose/conclude.h"
#include "tools/diagnose/diagnose.h"
#include "tools/diagnose/remaining_force.h"

namespace loopwright::diagnosis {

struct Staircase {
  std::vector<size_t> order;         ///< of the members, weightiest first
  std::vector<DiagnosisStep> steps;  ///< the nominal diagram, then one more step for each
};

/// Takes the members away again, each time the one that is missed least; what is left is fitted anew.
/// Corrections of the nominal diagram's own mass and damping go with the effect without which they are worth
/// nothing.
Staircase climb(Trials& trials, const Conclusion& conclusion, const std::vector<InverseDynamics>& inverse,
                size_t catalogue);

}  // namespace loopwright::diagnosis
