/// Logs of Simulink among the variables of a MAT file.
#pragma once
#include <string>
#include <vector>

#include "engine/record/mat_variables.h"

namespace loopwright::mat {

/// Simulink's "structure with time" and a timeseries stored as a structure become plain columns. Everything
/// else about their signals is dropped.
///
///     log.time, log.signals[i].values, log.signals[i].label   → log.time, log.LABEL or log.signals[i]
///     log.Time, log.Data, log.TimeInfo.Units, log.DataInfo.Units   → log.Time, log.Data with their units
///
/// Returns errors: a "structure" without time; a unit of time that is not known.
std::vector<std::string> unfold_logs(std::vector<Variable>& variables);

/// The length of the columns: that of the time, if one variable alone is called so; else of the longest
/// vector; else of the longest side of a matrix.
size_t length_of_columns(const std::vector<Variable>& variables);

}  // namespace loopwright::mat
