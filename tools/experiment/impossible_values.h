/// Numbers in a record that no sensor gives.
#pragma once
#include "tools/experiment/experiment.h"

namespace loopwright {

/// Reports a problem for each recorded signal with values that no unit makes possible, as the largest number
/// of a type, by which some programs mark a missing one.
void reject_impossible_values(const Experiment& experiment, Problems& problems);

}  // namespace loopwright
