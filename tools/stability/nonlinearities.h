/// Memoryless blocks whose slope varies over the range of a run.
#pragma once
#include "tools/stability/stability.h"

namespace loopwright {

/// The range of every number of a plan over a run.
struct VisitedRanges {
  std::vector<double> low, high;  ///< one for each number of the plan
};

/// Runs the plan and calls `at_stop` with the run at its end. Throws Interrupted, or std::runtime_error
/// when it fails.
VisitedRanges visit(const Plan& plan, const RunOptions& options,
                    const std::function<void(Run<double>&)>& at_stop);

/// Blocks without states whose slopes differ over the box of their inputs' ranges, widened by a tenth. Slopes
/// are evaluated at `points` quasi-random points (J. H. Halton, 1960): a grid, not a proof, fine enough for
/// functions that vary slowly relative to the distance of points. `linear` gets the middle of the slopes.
std::vector<Nonlinearity> find_nonlinearities(const Run<double>& run, const VisitedRanges& visited,
                                              LinearDiagram& linear, int points = 4000);

}  // namespace loopwright
