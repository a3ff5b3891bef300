/// A diagram that runs freely along the records, begun anew at stated intervals: what an explanation is
/// worth.
#pragma once
#include "tools/diagnose/verdict/improve.h"
#include "tools/diagnose/search/remaining_force.h"

namespace loopwright::diagnosis {

/// Errors of the first measured port over the windows of all records, in their order.
struct FreeRun {
  double horizon_s = 0;         ///< length of a window
  std::vector<double> squares;  ///< mean squared error of each window
  bool diverged = false;        ///< became non-finite, or left the range of the motion far behind
  double rmse() const;
};

/// Before each window the position and the velocity are set to the measured ones at every sample for as long
/// as the window lasts, so that lags, hysteresis and loads behind a gap reach their states. In the window
/// only the recorded input acts. An offset of the sensor and an error of the velocity at its start are
/// estimated in each window, because the motion is measured with noise: what remains is what the forces are
/// wrong by. A window lasts many time constants of a predictor with this noise. Windows without missing
/// samples, over the held-out rows where there are any. Empty for maps.
FreeRun run_freely(const std::vector<Member>& members, const Improver& improver, const LoadOptions& load,
                   const Trials& trials, const std::vector<InverseDynamics>& inverse, const Noise& noise);

/// Whether the second is worse than the first, by more than the scatter between windows: of the differences;
/// of the logarithms of the ratios, because errors of fast and slow windows differ by orders of magnitude; or
/// of the first, if several windows of the second are far worse.
bool is_worse(const FreeRun& before, const FreeRun& after);

}  // namespace loopwright::diagnosis
