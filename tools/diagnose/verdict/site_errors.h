/// How well a hypothesis about a diagram predicts and simulates.
#pragma once
#include <optional>
#include "tools/diagnose/search/site_fit.h"

namespace loopwright::diagnosis {

struct SiteErrors {
  bool diverges = false;
  std::vector<double> predicted, held_out;           ///< rms for each output, one sample ahead
  std::vector<double> simulated;                     ///< rms for each output, see errors_of()
  std::vector<double> expected_simulated;            ///< the same, if nothing but noise were left
  double mean_square = 0, held_out_mean_square = 0;  ///< of the whitened errors
  double portmanteau = 0;          ///< n Σ ρ² over 40 lags, the worst output; 40 when white
  std::vector<double> noise;       ///< rms for each output, if nothing but noise were left
  bool leaves_slow_error = false;  ///< larger than the noise of the measurement
};

/// Over the whole record. The simulation begins anew from the filtered states ten times, over the held-out
/// rows if there are any. Of an answer by simulation all errors are those of simulation_errors().
SiteErrors errors_of(SiteFitter& whole_record, SiteHypothesis hypothesis);

/// The output that the simulation misses worst, if by more than so many times the noise of its sensor.
std::optional<size_t> missed_output(const SiteErrors& errors, const SiteNoise& noise, double times);

/// rms error of an output's simulation, which the noise of its sensor and of the states explains at most.
double explained_by_noise(const SiteErrors& errors, const SiteNoise& noise, size_t output);

/// Whether simulations without the optional terms, with all else as it was fitted beside them, are as good.
bool simulates_without(SiteFitter& fitter, const SiteHypothesis& found, const std::vector<bool>& optional,
                       const SiteErrors& with_all);

/// Whether simulations contradict what one-step predictions say: one is worse than that of the diagram as it
/// is, or neither a simulation nor, of held-out rows, a prediction is better.
bool simulates_worse(const SiteErrors& errors, const SiteErrors& nominal, bool holds_out);

/// Whether the simulation misses the record by no more than the arithmetic does.
bool is_exact(const SiteErrors& errors, const SignalRecord& record);

}  // namespace loopwright::diagnosis
