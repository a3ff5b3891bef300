/// A record of any diagram: the inputs that drive it and the outputs that were measured, at their own time
/// stamps.
#pragma once
#include <optional>
#include <string>
#include <vector>
#include "tools/diagnose/diagnosis.h"
#include "tools/experiment/experiment.h"

namespace loopwright::diagnosis {

struct RecordedInput {
  std::string port, unit;
  BetweenRows between_rows = BetweenRows::hold;
  std::vector<double> value;  ///< SI, at the time stamps
};

struct RecordedOutput {
  std::string port, unit;
  double resolution = 0;       ///< SI; 0: not stated
  std::vector<double> value;   ///< SI, at the time stamps; NaN: no reading
  size_t leaps_by_a_turn = 0;  ///< rows in which an angle begins anew, as recorded
};

struct SignalRecord {
  std::string title, path;
  std::vector<double> time;  ///< s, increasing within a record, at any distance
  double sample_time = 0;    ///< s; the median distance of the time stamps
  std::vector<RecordedInput> inputs;
  std::vector<RecordedOutput> outputs;
  size_t held_out_from = 0;       ///< first row held out of the identification; rows() without hold-out
  std::vector<bool> begins;       ///< of several records: rows at which one begins, with states of its own
  std::vector<size_t> of_record;  ///< of several records: the one to which each row belongs
  size_t false_readings = 0;      ///< see loopwright::false_readings; they count as missing
  std::optional<RecordFinding> shortened;  ///< how, if there were too many rows

  size_t rows() const { return time.size(); }
  bool begins_at(size_t row) const { return row == 0 || (row < begins.size() && begins[row]); }
  /// Rows that are not held out and in which something was measured: a slow sensor has few of them.
  size_t fitted_rows() const;
  /// Rows in which a filter still learns where a record, or its part that is held out, begins.
  std::vector<bool> settling_rows() const;
  /// Length of the sample that begins at the row; that of the last row of a record is typical.
  double step(size_t row) const {
    return row + 1 < time.size() && !begins_at(row + 1) ? time[row + 1] - time[row] : sample_time;
  }
};

/// What the experiment drives and compares. Problems: nothing drives the diagram, too few rows, a column that
/// does not change.
SignalRecord read_signal_record(const Experiment& experiment, Problems& problems);

/// Several records of one diagram, one after the other: what is fitted of each, then what is held out. A
/// record that is held out in part begins a second time there. `time` is that of each record. Too many rows
/// are shortened. Problems: records with other ports, nothing that is fitted.
SignalRecord joined(std::vector<SignalRecord> records, Problems& problems);

}  // namespace loopwright::diagnosis
