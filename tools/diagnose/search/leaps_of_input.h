/// Single values of a recorded input that are out of line: commands, or false readings.
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "engine/diagram/diagram.h"
#include "tools/diagnose/search/hypothesis.h"
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// Of all records, see AxisRecord.
size_t input_leaps(const Trials& trials);

/// Those without which the diagram as it is predicts the records better: the machine does not feel them, and
/// laws of the input would stand for them. Nothing where it feels all. `trials`: with them.
std::optional<InputLeaps> unfelt_leaps(const std::string& diagram,
                                       const std::vector<std::string>& experiments,
                                       const LoadOptions& options, Trials& trials);

/// The same of any diagram: those of the inputs that it does not feel are taken away. How many.
size_t take_unfelt_leaps_away(SiteFitter& fitter);

}  // namespace loopwright::diagnosis
