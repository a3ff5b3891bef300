/// Plots of recordings over time: of one run, or of several laid over each other.
#pragma once
#include <functional>
#include <string>
#include <vector>
#include "engine/record/recording.h"
#include "tools/report/report.h"

namespace loopwright {

/// Figures of the finite values of a signal; NaN if there are none.
struct SignalRange {
  double least = 0, greatest = 0, mean = 0, rms = 0;
  double last = 0;        ///< of all values, finite or not
  size_t not_finite = 0;  ///< values that are none
  explicit SignalRange(const std::vector<double>& values);
};

struct NamedRecording {
  std::string name;            ///< "stage.csv"; names are not repeated among those of one page
  const Recording* recording;  ///< its first column is the time
};

/// Scopes of the signals of the first recording, each signal beside the same signal of the others. A scope
/// has one unit and similar magnitudes, so that a small error is not hidden by a large motion. `is_held`:
/// whether a signal keeps its value between rows.
std::vector<report::Plot> scopes(const std::vector<NamedRecording>& runs,
                                 const std::function<bool(const std::string&)>& is_held);

/// Amplitudes over frequency of the same signals in the same groups; empty if the rows are not even.
std::vector<report::Plot> spectra(const std::vector<NamedRecording>& runs);

/// Least, greatest, mean, rms and last value of each signal, in the unit that the plots use, and how many
/// rows hold no number where some do not.
report::Table signal_table(const std::vector<NamedRecording>& runs);

/// What the others have that the first has not: a table of the differences of common signals over the common
/// time, plots of them, and notes about what could not be compared.
report::Section differences(const std::vector<NamedRecording>& runs);

}  // namespace loopwright
