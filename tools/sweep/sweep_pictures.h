/// Pictures of many runs that plots of curves cannot show.
#pragma once
#include "tools/report/report.h"
#include "tools/sweep/sensitivity.h"
#include "tools/sweep/sweep_page.h"

namespace loopwright {

/// The mean of a metric over the two axes on which it depends most.
report::Picture heat_map(const SweepPlan& plan, const Recording& table, size_t metric,
                         const std::vector<AxisEffect>& effects);

/// A line through all axes for each run (at most 300 of them), colored by the rank of a metric.
report::Picture parallel_coordinates(const SweepPlan& plan, const Recording& table, size_t metric);

/// Histogram of a metric with the worst runs, as links to their pages if these exist.
report::Picture worst_in_distribution(const SweepPlan& plan, const Recording& table, size_t metric,
                                      const std::vector<size_t>& worst, const TracePages& traces);

}  // namespace loopwright
