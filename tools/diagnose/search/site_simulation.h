/// How well a hypothesis simulates a record that nothing corrects.
#pragma once
#include <optional>
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

/// rms for each output. Each record, and what is held out of it, is simulated from the initial states that
/// fit it best.
struct SimulationErrors {
  std::vector<double> fitted, held_out;  ///< held_out is empty without held-out rows

  /// Over the held-out rows, if there are any.
  const std::vector<double>& judged() const { return held_out.empty() ? fitted : held_out; }
};

/// Nothing if the model diverges.
std::optional<SimulationErrors> simulation_errors(SiteFitter& fitter, const SiteHypothesis& hypothesis);

/// Whether a small deviation of a state grows along the fitted rows until a simulation tells nothing about
/// its cause: motion that is chaotic or unstable.
bool forgets_its_start(SiteFitter& fitter, SiteHypothesis hypothesis);

}  // namespace loopwright::diagnosis
