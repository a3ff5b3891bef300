/// Fits parameters of a diagram so that its simulation comes as close as possible to a recording.
#pragma once
#include "tools/compare/compare.h"

namespace loopwright {

struct FitOptions {
  int most_iterations = 40;  ///< of Levenberg-Marquardt; each costs a simulation per parameter
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(int iteration, double relative_error)> progress;
};

struct FittedParameter {
  std::string path, unit;  ///< as for `--set`; unit in SI
  double start = 0, value = 0;
  double low = 0, high = 0;                   ///< 95 % interval, from the scatter between parts of the record
  double least = -infinity, most = infinity;  ///< range allowed by the blocks that use it
  bool is_determined = true;                  ///< the record contains information about it
};

/// A compared signal: errors over the fitted rows, and over the held-out rows (0 without).
struct FittedSignal {
  std::string name, unit;
  double before = 0, after = 0, held_out_before = 0, held_out_after = 0;
};

struct Fit {
  std::vector<FittedParameter> parameters;
  std::vector<FittedSignal> signals;
  std::vector<std::string>
      warnings;  ///< parameters at a limit, combinations that the record cannot distinguish
  bool has_converged = false, was_interrupted = false;
  int simulations = 0;
};

/// Maximum likelihood with independent errors of the compared signals, whose sizes are estimated by the fit
/// itself: each signal is weighted by its rms error, twice. Rows held out by the experiment are left out.
/// Throws InputError: problems of diagram and experiment, parameters that do not exist or are not numbers.
Fit fit(const std::string& diagram, const std::string& experiment, const std::vector<std::string>& parameters,
        const LoadOptions& options = {}, const FitOptions& fit_options = {});

/// The diagram file with the fitted values in place of the old ones, otherwise as its author wrote it.
/// Problems: a value in the file of a subdiagram, or written as an expression.
std::string with_fitted_values(const std::string& diagram, const Fit& fit, Problems& problems);

std::string to_json(const Fit& fit);
std::string to_text(const Fit& fit);

}  // namespace loopwright
