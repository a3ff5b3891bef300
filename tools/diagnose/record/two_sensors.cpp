#include "tools/diagnose/record/two_sensors.h"
#include <algorithm>
#include <cmath>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

/// What both sensors say of the ways within stretches.
class Ways {
 public:
  void add(double by_position, double by_velocity) {
    xx_ += by_position * by_position, xv_ += by_position * by_velocity, vv_ += by_velocity * by_velocity;
    ++count_;
  }
  /// Of the velocity to the rate of the position. Noise of the position makes the first too small, and that
  /// of the velocity makes the second too large: the ratio lies between them.
  double least() const { return xv_ / xx_; }
  double most() const { return vv_ / xv_; }
  /// Standard error.
  double deviation() const {
    return std::sqrt(std::max(0.0, vv_ - xv_ * xv_ / xx_) / double(count_ - 1) / xx_);
  }
  bool are_enough() const { return count_ >= criteria::least_ways && xx_ > 0 && xv_ != 0; }

 private:
  double xx_ = 0, xv_ = 0, vv_ = 0;
  size_t count_ = 0;
};

}  // namespace

std::optional<double> velocity_over_rate(const AxisRecord& record) {
  const MeasuredPort* const position = record.find("position");
  const MeasuredPort* const velocity = record.find("velocity");
  if (!position || !velocity || record.is_map) return {};
  const std::vector<double>&x = position->value, &v = velocity->value;
  Ways ways;
  double way = 0, time = 0;
  for (size_t from = 0, k = 1; k < record.rows(); ++k) {
    const double step = record.sample_time * (record.duration.empty() ? 1 : record.duration[k - 1]);
    way += step * (v[k - 1] + v[k]) / 2, time += step;
    const bool is_whole = !record.is_missing(k) && std::isfinite(x[k] - x[from]) && std::isfinite(way);
    if (is_whole && time < criteria::way_s) continue;
    if (is_whole) ways.add(x[k] - x[from], way);
    from = k, way = time = 0;
  }
  if (!ways.are_enough()) return {};
  const auto [low, high] = std::minmax({ways.least(), ways.most()});
  const double difference =
      std::max(criteria::least_ratio_of_sensors, criteria::sure_ratio * ways.deviation());
  if (low - 1 > difference) return low;
  if (1 - high > difference) return high;
  return {};
}

}  // namespace loopwright::diagnosis
