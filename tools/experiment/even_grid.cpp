#include "tools/experiment/even_grid.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include "tools/experiment/signal_figures.h"

namespace loopwright {
namespace {

/// [samples] If more than a hundredth of the time stamps deviate further from the grid, these are not late
/// stamps of even samples. A few rows may have been delayed.
constexpr double most_late = 5, most_held_up = 0.01;
/// [samples] A step of irregular times from which on samples are missing in it.
constexpr double gap = 2.5;
/// The times along which the measured signals are rougher by this factor are wrong.
constexpr double clearly_rougher = 1.2;

/// Whether the measured signals are smoother along their own times than along even samples.
bool times_are_own(const Experiment& experiment, const std::vector<double>& own,
                   const std::vector<int64_t>& sample) {
  const std::vector<double> even(sample.begin(), sample.end());
  double ratio = 1;
  for (const RecordedSignal& signal : experiment.compared) {
    const Column* column = experiment.data.find(signal.port);
    if (!column) continue;
    const double along_own = roughness(own, column->values), along_even = roughness(even, column->values);
    if (along_own > 0 && along_even > 0) ratio = std::max(ratio, along_even / along_own);
  }
  return ratio > clearly_rougher;
}

/// The instants of samples of these durations, in sample times from the first.
std::vector<double> instants(const std::vector<double>& duration) {
  std::vector<double> at{0};
  for (size_t k = 0; k + 1 < duration.size(); ++k) at.push_back(at.back() + duration[k]);
  return at;
}

}  // namespace

EvenGrid::EvenGrid(const Experiment& experiment) : sample_time_(experiment.time.sample_time) {
  const std::vector<double>& time = experiment.data.columns.front().values;
  const std::vector<int64_t> sample = sample_numbers(time, sample_time_);
  std::vector<double> starts;
  for (size_t row = 0; row < time.size(); ++row)
    starts.push_back(time[row] - double(sample[row]) * sample_time_);
  std::ranges::nth_element(starts, starts.begin() + std::ptrdiff_t(starts.size() / 2));
  const double middle = starts[starts.size() / 2];
  const auto far = std::ranges::count_if(
      starts, [&](double start) { return std::abs(start - middle) > most_late * sample_time_; });
  const bool is_irregular = !experiment.time.on_grid && double(far) > most_held_up * double(time.size());
  std::vector<double> own;
  if (!experiment.time.on_grid)
    for (double t : time) own.push_back((t - time.front()) / sample_time_);
  if (is_irregular || (!own.empty() && times_are_own(experiment, own, sample))) {
    std::vector<int64_t> behind(time.size());  // samples up to the next row
    for (size_t row = 0; row + 1 < time.size(); ++row)
      behind[row] = !is_irregular                   ? sample[row + 1] - sample[row]
                    : own[row + 1] - own[row] > gap ? std::llround(own[row + 1] - own[row])
                                                    : 1;
    by_time(time, behind);
    return;
  }
  start_ = experiment.time.on_grid ? time.front() : std::round(middle / sample_time_) * sample_time_;
  by_sample(sample);
}

void EvenGrid::by_sample(const std::vector<int64_t>& sample) {
  for (size_t row = 0; row < sample.size(); ++row) {
    place_.push_back(double(sample[row]));
    row_.push_back(row), fraction_.push_back(0);
    if (row + 1 == sample.size()) break;
    const double step = double(sample[row + 1] - sample[row]);
    for (double i = 1; i < step; ++i) row_.push_back(row), fraction_.push_back(i / step);
  }
  if (row_.size() == sample.size()) return;
  for (double fraction : fraction_) missing_.push_back(fraction > 0);
}

void EvenGrid::by_time(const std::vector<double>& time, const std::vector<int64_t>& samples_behind) {
  start_ = time.front();
  for (size_t row = 0; row < time.size(); ++row) {
    place_.push_back((time[row] - start_) / sample_time_);
    const double count = double(std::max<int64_t>(samples_behind[row], 1));
    for (double i = 0; i < count && (i == 0 || row + 1 < time.size()); ++i) {
      row_.push_back(row), fraction_.push_back(i / count), missing_.push_back(i > 0);
      duration_.push_back(row + 1 < time.size() ? (time[row + 1] - time[row]) / sample_time_ / count : 1.0);
    }
  }
  if (std::ranges::find(missing_, char(1)) == missing_.end()) missing_.clear();
  if (duration_.size() < 2) return;
  const double mean =
      place_.back() / double(duration_.size() - 1);  // so that the even grid ends with the rows
  sample_time_ *= mean;
  for (double& place : place_) place /= mean;
  for (double& duration : duration_) duration /= mean;
}

/// Per sample: slope of the parabola through the row and the two rows before or after it.
double EvenGrid::slope_at(const std::vector<double>& column, size_t row, bool is_before) const {
  const auto slope = [&](size_t a, size_t b) { return (column[b] - column[a]) / (place_[b] - place_[a]); };
  const size_t last = column.size() - 1;
  if (is_before ? row == 0 : row == last) return 0;
  const size_t next = is_before ? row - 1 : row + 1;
  if (is_before ? next == 0 : next == last) return slope(row, next);
  const size_t far = is_before ? row - 2 : row + 2;
  return slope(row, next) + slope(row, far) - slope(next, far);
}

std::vector<double> EvenGrid::measured(const std::vector<double>& column) const {
  std::vector<double> values;
  values.reserve(row_.size());
  for (size_t k = 0; k < row_.size(); ++k) {
    const size_t row = row_[k];
    const double s = fraction_[k];
    if (s == 0) {
      values.push_back(column[row]);
      continue;
    }
    const double change = column[row + 1] - column[row];
    double value = column[row] + s * change;
    if (!missing_.empty() && missing_[k]) {  // by a cubic Hermite spline
      const double step = place_[row + 1] - place_[row];
      const double leaves = step * slope_at(column, row, true) - change;
      const double arrives = step * slope_at(column, row + 1, false) - change;
      value += s * (1 - s) * ((1 - s) * leaves - s * arrives);
    }
    values.push_back(value);
  }
  return values;
}

OverSamples EvenGrid::driving(const std::vector<double>& column, BetweenRows between) const {
  OverSamples over;
  if (between == BetweenRows::hold) {
    for (size_t row : row_) over.mean.push_back(column[row]);
    return over;
  }
  const RowCurve curve(place_, column, between);
  for (size_t k = 0; k < row_.size(); ++k) {
    const bool ends_row = k + 1 == row_.size() || row_[k + 1] != row_[k];
    const CubicPiece piece = curve.piece(row_[k]);
    const double end = ends_row ? 1 : fraction_[k + 1];
    const MeanLine line = piece.part(fraction_[k] * piece.length, end * piece.length).line();
    over.mean.push_back(line.mean), over.change.push_back(line.change);
  }
  return over;
}

std::vector<double> at_even_instants(const std::vector<double>& values, const std::vector<double>& duration) {
  if (duration.empty() || values.size() < 4) return values;
  const std::vector<double> at = instants(duration);
  std::vector<double> even;
  for (size_t k = 0, i = 0; k < values.size(); ++k) {
    const double now = std::min(double(k), at.back());
    while (i + 2 < at.size() && at[i + 1] <= now) ++i;
    const size_t first = std::clamp<size_t>(i, 1, at.size() - 3) - 1;
    double value = 0;
    for (size_t j = first; j < first + 4; ++j) {
      double weight = 1;
      for (size_t other = first; other < first + 4; ++other)
        if (other != j) weight *= (now - at[other]) / (at[j] - at[other]);
      value += weight * values[j];
    }
    even.push_back(value);
  }
  return even;
}

std::vector<double> edges_of(const std::vector<double>& duration) {
  std::vector<double> edges = instants(duration);
  edges.push_back(edges.back() + duration.back());
  return edges;
}

OverSamples over_other_intervals(const OverSamples& signal, const std::vector<double>& edges,
                                 const std::vector<double>& others) {
  const size_t count = others.size() - 1, last = signal.mean.size() - 1;
  OverSamples result{std::vector<double>(count), std::vector<double>(count)};
  for (size_t k = 0, i = 0; k < count; ++k) {
    const double begin = others[k], end = others[k + 1], length = end - begin;
    double area = 0, moment = 0;
    for (double from = begin; from < end;) {
      while (i < last && edges[i + 1] <= from) ++i;
      const double to = i < last ? std::min(end, edges[i + 1]) : end, part = to - from;
      const double slope = signal.change.empty() ? 0 : signal.change[i] / (edges[i + 1] - edges[i]);
      const double centre = 0.5 * (from + to);
      const double value = signal.mean[i] + slope * (centre - 0.5 * (edges[i] + edges[i + 1]));
      area += part * value;
      moment += part * value * (centre - 0.5 * (begin + end)) + slope * part * part * part / 12;
      from = to;
    }
    result.mean[k] = area / length, result.change[k] = 12 * moment / (length * length);
  }
  return result;
}

std::vector<double> mean_over_even_samples(const std::vector<double>& means,
                                           const std::vector<double>& duration) {
  if (duration.empty()) return means;
  std::vector<double> even;
  for (size_t k = 0; k <= means.size(); ++k) even.push_back(double(k));
  return over_other_intervals({means, {}}, edges_of(duration), even).mean;
}

std::string too_many_missing(const Experiment& experiment) {
  constexpr double most = 20;  // for each row
  const double rows = double(experiment.data.rows()), missing = double(experiment.time.missing);
  if (missing <= most * rows) return {};
  return fmt::format("of {:.0f} samples only {:.0f} were recorded: cut the record where it was interrupted",
                     rows + missing, rows);
}

}  // namespace loopwright
