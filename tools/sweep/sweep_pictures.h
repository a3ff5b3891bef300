/// Pictures of many runs that plots of curves cannot show.
#pragma once
#include "tools/report/report.h"
#include "tools/sweep/sensitivity.h"
#include "tools/sweep/sweep_page.h"

namespace loopwright {

/// The mean of a metric over the two axes that it hangs on most.
report::Picture heat_map(const SweepPlan& plan, const Recording& table, size_t metric,
                         const std::vector<AxisEffect>& effects);

/// A line through all axes for each run (300 of them at most), coloured by the rank of a metric.
report::Picture parallel_coordinates(const SweepPlan& plan, const Recording& table, size_t metric);

/// How often a metric takes which value, and where the worst runs lie, as links to their pages where there
/// are some.
report::Picture worst_in_distribution(const SweepPlan& plan, const Recording& table, size_t metric,
                                      const std::vector<size_t>& worst, const TracePages& traces);

}  // namespace loopwright
