/// The uniform grid on which a record is analyzed.
#pragma once
#include <vector>
#include "tools/experiment/experiment.h"

namespace loopwright {

/// A driving signal over each sample: its mean, and the change of the line with the same first moment.
struct OverSamples {
  std::vector<double> mean;
  std::vector<double> change;  ///< empty: held
};

/// The samples of a record one after the other, with those that have no row, such as lost samples of a
/// device, in their places, so that later rows are not shifted forward.
///
/// Times that are not even have one of two causes. Either the rows were sampled evenly and their stamps came
/// late: then each row is a sample of the grid. Or they were sampled at these times: then samples differ in
/// `duration`. The measured signals tell which: a smooth motion is rough along the wrong times.
class EvenGrid {
 public:
  explicit EvenGrid(const Experiment& experiment);

  double start() const { return start_; }              ///< [s]
  double sample_time() const { return sample_time_; }  ///< [s] the mean if samples differ
  size_t rows() const { return row_.size(); }
  /// Samples without a row; empty when there are none.
  const std::vector<char>& missing() const { return missing_; }
  /// [sample times] From each sample to the next; empty when all are 1.
  const std::vector<double>& duration() const { return duration_; }
  /// A measured column at the samples. Missing samples are bridged by a curve with the values and slopes of
  /// the rows around them.
  std::vector<double> measured(const std::vector<double>& column) const;
  /// A held one is held over missing samples, too, as a device holds it.
  OverSamples driving(const std::vector<double>& column, BetweenRows between) const;

 private:
  void by_sample(const std::vector<int64_t>& sample);
  void by_time(const std::vector<double>& time, const std::vector<int64_t>& samples_behind);
  double slope_at(const std::vector<double>& column, size_t row, bool is_before) const;

  double start_ = 0, sample_time_ = 0;
  std::vector<size_t> row_;       // at each sample its row, or the previous one
  std::vector<double> fraction_;  // fraction of the way to the next row
  std::vector<double> place_;     // [samples] of each row
  std::vector<double> duration_;
  std::vector<char> missing_;
};

/// Values at samples of these durations as they were at even instants, by cubics through the four samples
/// around each. Unchanged without durations.
std::vector<double> at_even_instants(const std::vector<double>& values, const std::vector<double>& duration);
/// [sample times] Where samples of these durations begin, and where the last one ends.
std::vector<double> edges_of(const std::vector<double>& duration);
/// A signal over samples with these edges, over intervals with others: over each the line with the same
/// integral and the same first moment. Beyond its last sample the signal goes on along its line.
OverSamples over_other_intervals(const OverSamples& signal, const std::vector<double>& edges,
                                 const std::vector<double>& others);
/// The mean over each even sample of a command with these means over the samples.
std::vector<double> mean_over_even_samples(const std::vector<double>& means,
                                           const std::vector<double>& duration);

/// A sentence if too many samples are missing for the record to be used; otherwise empty.
std::string too_many_missing(const Experiment& experiment);

}  // namespace loopwright
