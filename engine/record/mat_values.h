/// The values of matio as plain values.
#pragma once
#include <matio.h>

#include <vector>

#include "engine/record/mat_variables.h"

namespace loopwright::mat {

/// Appends a variable, or the fields of a structure under their paths: "log.time", "log.signals[1].values".
/// Empty fields of structures are left out, except a time.
void append(std::vector<Variable>& list, matvar_t& source);

}  // namespace loopwright::mat
