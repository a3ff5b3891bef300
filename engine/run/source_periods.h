/// Periods of the diagram's own signals, so that no step leaps over them.
#pragma once
#include <string>
#include "engine/run/run.h"

namespace loopwright {

/// The longest step [s] that a variable-step method takes unless the diagram says otherwise: a quarter of the
/// shortest period of a source that is not sampled. Without states, whose error would shorten steps, at most
/// the plan's typical step.
double default_maximum_step(const Run<double>& run);

/// What to say where a fixed step or a sample time sees a source less than twice in a period; empty: nothing.
std::string aliasing_warning(const Run<double>& run);

}  // namespace loopwright
