/// Rows of logged signals. Memory for all rows is allocated before the run; adding a row allocates nothing.
#pragma once
#include "engine/record/recording.h"
#include "engine/run/run.h"

namespace loopwright {

class Recorder {
 public:
  /// Throws InputError if the rows do not fit into memory.
  explicit Recorder(const Plan& plan);

  void record(const Run<double>& run);
  /// The first logged signal of the last row that is non-finite; -1: none.
  int first_non_finite() const;
  int64_t rows() const { return int64_t(recording_.columns[0].values.size()); }
  Recording& recording() { return recording_; }

 private:
  const Plan& plan_;
  Recording recording_;
};

}  // namespace loopwright
