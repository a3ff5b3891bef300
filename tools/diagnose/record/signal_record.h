/// A record of any diagram: the inputs that drive it and the outputs that were measured, at their own time
/// stamps.
#pragma once
#include <string>
#include <vector>
#include "tools/experiment/experiment.h"

namespace loopwright::diagnosis {

struct RecordedInput {
  std::string port, unit;
  bool is_linear = false;     ///< straight lines between the samples; otherwise held
  std::vector<double> value;  ///< SI, at the time stamps
};

struct RecordedOutput {
  std::string port, unit;
  double resolution = 0;      ///< SI; 0: not stated
  std::vector<double> value;  ///< SI, at the time stamps; NaN: no reading
};

struct SignalRecord {
  std::string title, path;
  std::vector<double> time;  ///< s, increasing, at any distance
  double sample_time = 0;    ///< s; the median distance of the time stamps
  std::vector<RecordedInput> inputs;
  std::vector<RecordedOutput> outputs;
  size_t held_out_from = 0;  ///< first row held out of the identification; rows() without hold-out

  size_t rows() const { return time.size(); }
  /// Length of the sample that begins at the row; that of the last row is typical.
  double step(size_t row) const { return row + 1 < time.size() ? time[row + 1] - time[row] : sample_time; }
};

/// What the experiment drives and compares. Problems: nothing drives the diagram, too few rows, a column that
/// does not change.
SignalRecord read_signal_record(const Experiment& experiment, Problems& problems);

}  // namespace loopwright::diagnosis
