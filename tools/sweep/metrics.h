/// The metrics of a sweep, computed while many runs proceed in parallel.
#pragma once
#include <memory>
#include "engine/plan/plan.h"
#include "tools/sweep/sweep.h"

namespace loopwright {

/// What the metrics of a sweep read from one plan.
struct Observed {
  std::vector<Number> numbers;                 ///< to be read at every row
  std::vector<std::vector<size_t>> of_metric;  ///< the numbers of each metric's signal, by their index
  std::vector<std::string> units;              ///< unit of each metric
  std::vector<double> scales;                  ///< SI per unit
};

/// Looks up the signals of all metrics; problems at their source locations in the sweep file.
Observed observe(const Sweep& sweep, const Plan& plan, Problems& problems);

/// Accumulators of all metrics for `lanes` runs. Each lane's numbers are added in the order of its rows, so
/// that a metric has the same bits at every vector width.
class MetricBank {
 public:
  MetricBank(const Sweep& sweep, const Observed& observed, int lanes);
  ~MetricBank();
  void reset();
  /// `values[i · lanes + lane]`: the observed numbers at a row.
  void add(double time, const double* values);
  /// For one lane, in the units of the metrics.
  std::vector<double> results(int lane);

 private:
  struct Accumulator;
  std::vector<std::unique_ptr<Accumulator>> accumulators_;
};

}  // namespace loopwright
