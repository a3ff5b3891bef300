/// The uniform grid on which a record is analyzed.
#pragma once
#include <vector>
#include "tools/experiment/experiment.h"

namespace loopwright {

/// Rows whose time stamps only jitter are placed on the grid one after the other. Samples without a row, such
/// as lost samples of a device, keep their position on the grid, so later rows are not shifted forward.
class EvenGrid {
 public:
  explicit EvenGrid(const Experiment& experiment);

  double start() const { return start_; }              ///< [s]
  double sample_time() const { return sample_time_; }  ///< [s] the median if time stamps jitter
  size_t rows() const { return row_.size(); }
  /// Samples without a row; empty when there are none.
  const std::vector<char>& missing() const { return missing_; }
  /// A measured column on the grid. Missing samples are bridged by a curve with the values and slopes of the
  /// rows around them.
  std::vector<double> measured(const std::vector<double>& column) const;
  /// A command on the grid: held over missing samples, as a device holds it.
  std::vector<double> held(const std::vector<double>& column) const;

 private:
  void by_sample(const std::vector<int64_t>& sample);
  void by_time(const std::vector<double>& time);
  double slope_at(const std::vector<double>& column, size_t row, bool is_before) const;

  double start_ = 0, sample_time_ = 0;
  std::vector<size_t> row_;       // at each sample its row, or the previous one
  std::vector<double> fraction_;  // fraction of the way to the next row
  std::vector<double> place_;     // [samples] of each row
  std::vector<char> missing_;
};

/// A sentence if too many samples are missing for the record to be used; otherwise empty.
std::string too_many_missing(const Experiment& experiment);

}  // namespace loopwright
