/// Single values of a recorded input that leap out and back: commands, or false readings.
#pragma once
#include <string>
#include <vector>
#include "engine/diagram/diagram.h"
#include "tools/diagnose/search/hypothesis.h"
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// Whether the diagram as it is predicts the records better without them: then the machine does not feel
/// them, and laws of the input would stand for them. `trials`: with them.
bool does_not_feel_leaps(const std::string& diagram, const std::vector<std::string>& experiments,
                         const LoadOptions& options, Trials& trials, const Motion& motion);

/// The same of any diagram: those of the inputs that it does not feel are taken away. How many.
size_t take_unfelt_leaps_away(SiteFitter& fitter);

}  // namespace loopwright::diagnosis
