/// Robustness of each variant: how a metric varies along each axis.
#pragma once
#include "tools/report/report.h"
#include "tools/sweep/run_sweep.h"

namespace loopwright {

/// A metric over the runs of one variant in one bin of an axis, for all values of the other axes.
struct Spread {
  double from = 0, to = 0;               ///< the bin, in the unit of the sweep file
  double low = 0, median = 0, high = 0;  ///< quartiles of the runs; infinite if they failed
};

/// spread[variant][bin] along one axis.
struct Profile {
  size_t axis = 0;
  std::vector<std::vector<Spread>> spread;
};

/// A profile for every axis except `by`, the axis of variants. A run that failed counts as infinite.
std::vector<Profile> profiles_of(const SweepPlan& plan, const Recording& table, size_t metric, size_t by);

/// A panel for every axis, a curve and a band for every variant: low and flat means robust.
report::Picture robustness_picture(const SweepPlan& plan, const Recording& table, size_t metric, size_t by);

/// The same in numbers: for each variant its median, 95 % and worst value, and the factor by which each axis
/// changes the median.
report::Table robustness_table(const SweepPlan& plan, const Recording& table, size_t metric, size_t by);

}  // namespace loopwright
