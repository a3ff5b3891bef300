/// Fits parameters of a diagram so that its simulation comes as close as possible to recordings.
#pragma once
#include "tools/compare/compare.h"

namespace loopwright {

/// Bounds of a parameter, in SI.
struct ParameterRange {
  std::string path;
  double low = 0, high = 0;
};

struct FitOptions {
  int most_iterations = 40;            ///< of Levenberg-Marquardt; each costs a simulation per parameter
  std::vector<ParameterRange> ranges;  ///< in the place of the sign that a parameter begins with
  std::vector<std::string> of_each;    ///< parameters with an own value for every record: initial states
  std::vector<std::string> held_out;   ///< experiments that are not fitted, only compared before and after
  bool takes_offsets_out = false;      ///< the mean error of every compared signal of every record
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(int iteration, double relative_error)> progress;
};

struct FittedParameter {
  std::string path, unit;  ///< as for `--set`; unit in SI
  double start = 0, value = 0;
  double low = 0, high = 0;  ///< 95 % interval, from the scatter between parts of the records
  double least = -infinity,
         most = infinity;     ///< allowed by its blocks, by its sign at the start, or by a range
  bool is_determined = true;  ///< the records contain information about it
};

/// A compared signal: errors over the fitted rows, and over the held-out rows (0 without).
struct FittedSignal {
  std::string name, unit;
  double before = 0, after = 0, held_out_before = 0, held_out_after = 0;
};

struct FittedRecord {
  std::string experiment;
  bool is_held_out = false;                 ///< as a whole
  std::vector<FittedParameter> parameters;  ///< of this record alone: FitOptions::of_each
  std::vector<FittedSignal> signals;
};

/// How the estimates of the parameters depend on each other: the correlation of each two, from -1 to 1.
struct FitCorrelations {
  std::vector<std::string> names;            ///< of all unknowns
  std::vector<std::vector<double>> of_each;  ///< by row and column; empty without intervals
};

struct Fit {
  std::vector<FittedParameter> parameters;  ///< shared by all records
  std::vector<FittedSignal> signals;        ///< over all records
  std::vector<FittedRecord> records;
  std::vector<std::string>
      warnings;  ///< parameters at a limit, combinations that the records cannot distinguish
  FitCorrelations correlations;
  std::vector<Comparison> before, after;  ///< of each record
  bool has_converged = false;
  /// The values are those of the last finished round, without intervals (NaN); without parameters if not even
  /// the first simulation was finished.
  bool was_interrupted = false;
  int simulations = 0;

  bool is_as_at_start() const;  ///< no shared parameter has another value
};

/// Maximum likelihood with independent errors of the compared signals, whose sizes are estimated by the fit
/// itself: each signal is weighted by its rms error over all records, twice. Rows held out by an experiment
/// are left out. A parameter keeps its sign, unless a range allows the other one. The values never explain
/// the records worse than those at the start, which stay if no better ones are found. Throws InputError:
/// problems of diagram and experiments, parameters that do not exist or are not numbers, ranges without them.
Fit fit(const std::string& diagram, const std::vector<std::string>& experiments,
        const std::vector<std::string>& parameters, const LoadOptions& options = {},
        const FitOptions& fit_options = {});

/// The diagram file with the fitted values in place of the old ones, otherwise as its author wrote it; values
/// of single records are left out. Problems: a value in the file of a subdiagram, or written as an
/// expression.
std::string with_fitted_values(const std::string& diagram, const Fit& fit, Problems& problems);

std::string to_json(const Fit& fit);
std::string to_text(const Fit& fit);
/// `title`: of the page, such as the name of the diagram.
report::Page fit_page(const Fit& fit, const std::string& title);

}  // namespace loopwright
