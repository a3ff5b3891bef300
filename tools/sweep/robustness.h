/// Which variant is robust to what: how a metric spreads along each axis, variant by variant.
#pragma once
#include "tools/report/report.h"
#include "tools/sweep/run_sweep.h"

namespace loopwright {

/// A metric over the runs of one variant in one bin of an axis, whatever the other axes are there.
struct Spread {
  double from = 0, to = 0;               ///< the bin, as the sweep file states the axis
  double low = 0, median = 0, high = 0;  ///< quartiles of the runs; infinite where they failed
};

/// spread[variant][bin] along one axis.
struct Profile {
  size_t axis = 0;
  std::vector<std::vector<Spread>> spread;
};

/// A profile for every axis beside `by`, the axis of variants. A run that failed counts as infinite.
std::vector<Profile> profiles_of(const SweepPlan& plan, const Recording& table, size_t metric, size_t by);

/// A panel for every axis, a curve and a band for every variant: low and flat is robust.
report::Picture robustness_picture(const SweepPlan& plan, const Recording& table, size_t metric, size_t by);

/// The same in numbers: for each variant its median, 95 % and worst, and by what factor each axis moves the
/// median.
report::Table robustness_table(const SweepPlan& plan, const Recording& table, size_t metric, size_t by);

}  // namespace loopwright
