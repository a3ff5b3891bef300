/// The results of a sweep as one page.
#pragma once
#include <map>
#include "tools/report/report.h"
#include "tools/sweep/run_sweep.h"

namespace loopwright {

/// Pages on single runs, by the run's number, as links from the page of the sweep.
using TracePages = std::map<int64_t, std::string>;

report::Page sweep_page(const SweepPlan& plan, const SweepResults& results, const TracePages& traces = {});

/// Runs by a metric, the worst first: the largest, or the smallest if only a lower limit is set.
std::vector<size_t> worst_rows(const SweepPlan& plan, const Recording& table, size_t metric, size_t most);

/// The rows whose run keeps its trace.
std::vector<int64_t> runs_to_keep(const SweepPlan& plan, const SweepResults& results);

}  // namespace loopwright
