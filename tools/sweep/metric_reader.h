/// Reads the metrics of a sweep file.
#pragma once
#include "engine/json/reader.h"
#include "tools/sweep/sweep.h"

namespace loopwright {

/// The member "metrics" of the file. A metric with a problem that leaves its kind undetermined is left out.
std::vector<Metric> read_metrics(const Reader& reader, const Value& file);

}  // namespace loopwright
