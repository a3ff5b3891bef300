/// The even grid on which a record is looked at.
#pragma once
#include <vector>
#include "tools/compare/experiment.h"

namespace loopwright {

/// Rows whose time stamps only tremble stand on the grid one after the other. Samples without a row, such as
/// those that a device lost, keep their places: the rows behind them are not taken for earlier ones.
class EvenGrid {
 public:
  explicit EvenGrid(const Experiment& experiment);

  double start() const { return start_; }              ///< [s]
  double sample_time() const { return sample_time_; }  ///< [s] the median, where stamps tremble
  size_t rows() const { return row_.size(); }
  /// Samples without a row; empty when there are none.
  const std::vector<char>& missing() const { return missing_; }
  /// A measured column on the grid; over missing samples a curve that leaves and arrives as the rows around
  /// them do.
  std::vector<double> measured(const std::vector<double>& column) const;
  /// A command on the grid: held over missing samples, as a device holds it.
  std::vector<double> held(const std::vector<double>& column) const;

 private:
  void by_sample(const std::vector<int64_t>& sample);
  void by_time(const std::vector<double>& time);
  double slope_at(const std::vector<double>& column, size_t row, bool is_before) const;

  double start_ = 0, sample_time_ = 0;
  std::vector<size_t> row_;       // at each sample the row there, or the last one before
  std::vector<double> fraction_;  // of the way to the next row
  std::vector<double> place_;     // [samples] of each row
  std::vector<char> missing_;
};

/// Whether so many samples are missing that the record is no longer one: a sentence, or nothing.
std::string too_many_missing(const Experiment& experiment);

}  // namespace loopwright
