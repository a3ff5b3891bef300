/// The keys of sweep files, for their reader and for the JSON Schema.
#pragma once
#include "engine/json/file_shape.h"
#include "tools/sweep/sweep.h"

namespace loopwright {

/// More runs are a mistake in a file.
inline constexpr double most_runs = 1e9;

FileShape sweep_shape();
/// One alternative for each way in which an axis varies.
FileShape axis_shape();
FileShape grid_shape();          ///< of "linear" and "logarithmic"
FileShape distribution_shape();  ///< of "uniform" and "log_uniform"
FileShape normal_shape();
FileShape samples_shape();
FileShape worst_shape();     ///< of "keep": the worst runs
FileShape selected_shape();  ///< of "keep": some runs
/// A metric of one kind, with the keys that only this kind has.
FileShape metric_shape(Metric::Kind kind);

}  // namespace loopwright
