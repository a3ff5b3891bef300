/// The axis values of each run of a sweep: a function of its number alone, so that a million runs need no
/// memory.
#pragma once
#include <memory>
#include <span>
#include "tools/sweep/sweep.h"

namespace loopwright {

class SweepDesign {
 public:
  /// `changes_plan`: one flag per axis whose values need separate plans; these axes vary slowest.
  SweepDesign(const Sweep& sweep, std::vector<bool> changes_plan);

  int64_t runs() const { return worlds_ * runs_in_world(); }
  /// Points of the axes that change the plan; runs of one world are consecutive.
  int64_t worlds() const { return worlds_; }
  int64_t runs_in_world() const { return grid_ * samples_; }
  /// One value per axis, in the unit of the file; for variants the index.
  std::vector<double> point(int64_t run) const;
  /// The least and greatest value of each axis over all runs: {point, point}.
  std::pair<std::vector<double>, std::vector<double>> range() const;

  /// Value of a sampled axis for u in (0, 1).
  static double quantile(const Axis& axis, double u);

 private:
  double uniform(int64_t sample, size_t rank) const;
  std::vector<double> sobol(int64_t sample) const;

  const Sweep& sweep_;
  std::vector<size_t> digits_;   ///< grid axes, slowest first
  std::vector<size_t> sampled_;  ///< axes
  int64_t worlds_ = 1, grid_ = 1, samples_ = 1;
};

}  // namespace loopwright
