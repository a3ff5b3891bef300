/// The point of a sweep at which a metric is smallest or largest: the best setting, or the worst case.
#pragma once
#include <atomic>
#include <functional>
#include "tools/sweep/sweep_plan.h"

namespace loopwright {

struct OptimiseOptions {
  std::string metric;
  bool maximise = false;
  int evaluations = 300;  ///< runs of each variant; two thirds search globally, the rest near the best
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(int done, int total)> progress;
};

struct Optimum {
  bool found = false;  ///< at least one run finished
  bool interrupted = false;
  std::vector<double> point;  ///< one per axis, as SweepDesign::point
  double value = 0;           ///< of the metric, in its unit
  int evaluations = 0, failed = 0;
};

/// Searches between the smallest and largest value of each axis (for a normal axis: three standard
/// deviations), on a logarithmic scale if the axis has one; paired axes move together, on straight lines between
/// the pairs of their lists. Variants and structural values are tried one after the other. First NLopt's DIRECT-L (Gablonsky & Kelley, J. Global Optim. 21 (2001) 27), then Sbplx.
/// The same sweep gives the same result. Throws InputError when there is no such metric.
Optimum optimise(const SweepPlan& plan, const OptimiseOptions& options);

}  // namespace loopwright
