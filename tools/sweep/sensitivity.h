/// The axes on which a metric depends.
#pragma once
#include <optional>
#include "tools/sweep/run_sweep.h"

namespace loopwright {

/// Groups of the values of an axis that has many.
inline constexpr int most_bins = 12;

/// Values of an axis grouped together: each value separately, or quantiles of many values.
struct Bin {
  double from = 0, to = 0;  ///< smallest and largest value, as written in the sweep file
  double mean = 0;          ///< of the metric
  int64_t runs = 0;
};

struct AxisEffect {
  std::string axis;
  std::vector<Bin> bins;  ///< main effect: the mean of the metric along the axis
  /// First-order Sobol index: the share of the variance that the axis explains by itself. From the bins, (SSB
  /// - (k - 1) MSW) / SST, not below zero; for Saltelli's design by Jansen's estimator.
  double first_order = 0;
  double first_order_error = 0;  ///< standard error of the estimate
  /// Including all its interactions; only for Saltelli's design. Source: M. J. W. Jansen, Comput. Phys.
  /// Commun. 117 (1999) 35.
  std::optional<double> total;
  double total_error = 0;  ///< standard error of the estimate
};

/// One effect per axis, for one metric. Runs whose metric is not finite are left out.
std::vector<AxisEffect> effects_of(const SweepPlan& plan, const Recording& table, size_t metric);

/// The bin of each run on an axis.
std::vector<int> bins_of(const Axis& axis, const std::vector<double>& values, int most, int& count);

}  // namespace loopwright
