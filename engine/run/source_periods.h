/// Periods of the signals generated in the diagram, so that no step skips one.
#pragma once
#include <string>
#include "engine/run/run.h"

namespace loopwright {

/// The longest step [s] of a variable-step method unless the diagram gives another: a quarter of the shortest
/// period of a source that is not sampled. If there are no states, whose error would limit the steps, it is
/// at most the typical step of the plan.
double default_maximum_step(const Run<double>& run);

/// A warning if a fixed step or a sample time samples a source less than twice per period; otherwise empty.
std::string aliasing_warning(const Run<double>& run);

}  // namespace loopwright
