#include "tools/experiment/even_grid.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace loopwright {
namespace {

/// [samples] If more than a hundredth of the time stamps deviate further from the grid, this is not jitter:
/// their median step is not their mean step. A few rows may have been delayed.
constexpr double most_jitter = 5, most_held_up = 0.01;
/// A row whose stamp is further behind the previous one follows a lost sample.
constexpr double gap = 1.5;

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
      starts, [&](double start) { return std::abs(start - middle) > most_jitter * sample_time_; });
  if (double(far) > most_held_up * double(time.size())) {
    by_time(time);
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

void EvenGrid::by_time(const std::vector<double>& time) {
  start_ = std::ceil(time.front() / sample_time_) * sample_time_;
  for (double t : time) place_.push_back((t - start_) / sample_time_);
  const auto samples = size_t(std::max(place_.back(), 0.0));
  size_t row = 0;
  bool is_any_missing = false;
  for (size_t k = 0; k < samples; ++k) {
    while (row + 2 < time.size() && place_[row + 1] <= double(k) + 1e-6) ++row;
    const double step = place_[row + 1] - place_[row];
    row_.push_back(row);
    fraction_.push_back(std::clamp((double(k) - place_[row]) / step, 0.0, 1.0));
    missing_.push_back(step > gap && fraction_.back() > 0);
    is_any_missing |= missing_.back() != 0;
  }
  if (!is_any_missing) missing_.clear();
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

std::vector<double> EvenGrid::held(const std::vector<double>& column) const {
  std::vector<double> values;
  values.reserve(row_.size());
  for (size_t row : row_) values.push_back(column[row]);
  return values;
}

std::string too_many_missing(const Experiment& experiment) {
  constexpr double most = 20;  // for each row
  const double rows = double(experiment.data.rows()), missing = double(experiment.time.missing);
  if (missing <= most * rows) return {};
  return fmt::format("of {:.0f} samples only {:.0f} were recorded: cut the record where it was interrupted",
                     rows + missing, rows);
}

}  // namespace loopwright
