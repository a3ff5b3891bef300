#include "tools/diagnose/search/record_sizes.h"
#include <algorithm>
#include <cmath>
#include "models/real/fraction.h"
#include "models/real/whole.h"
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

/// The mean of uneven stamps has any digits, and its parts are then no whole number of ticks. A fraction that
/// is as close as no clock is has a denominator that leaves room to divide it.
double divisible(double sample_time) {
  constexpr double of_no_clock = 1e-9;
  const auto fraction = to_fraction(sample_time, of_no_clock);
  return fraction ? fraction->value() : sample_time;
}

}  // namespace

RecordSizes sizes_of(const std::vector<std::shared_ptr<const Path>>& paths,
                     const std::vector<const AxisModel*>& models) {
  RecordSizes sizes;
  double squared_force = 0, squared_input = 0, count = 0, low = 1e300, high = -1e300;
  double squared_inertial = 0, accelerations = 0;
  std::vector<double> speeds;
  for (size_t i = 0; i < paths.size(); ++i) {
    const Path& path = *paths[i];
    for (size_t k = 0; k < path.samples(); ++k) {
      low = std::min(low, path.predicted_position[k]), high = std::max(high, path.predicted_position[k]);
      if (double(k) * path.sample_time < criteria::speed_span_s || k == 0) continue;
      const double step = path.position[k] - path.position[k - 1];
      speeds.push_back(std::abs(models[i]->record().is_map ? step / path.sample_time : path.velocity[k]));
      if (path.rests[k]) continue;
      squared_force += path.force[k] * path.force[k], squared_input += path.input[k] * path.input[k];
      count += 1;
    }
    const size_t half =
        std::max<size_t>(1, whole_count(std::round(criteria::acceleration_span_s / 2 / path.sample_time)));
    for (size_t k = half; k + half < path.samples(); k += std::max<size_t>(1, half / 4)) {
      const double acceleration =
          std::abs(path.velocity[k + half] - path.velocity[k - half]) / (2 * double(half) * path.sample_time);
      sizes.top_acceleration = std::max(sizes.top_acceleration, acceleration);
      if (path.rests[k] || double(k - half) * path.sample_time < criteria::speed_span_s) continue;
      squared_inertial += std::pow(models[i]->nominal_inertia() * acceleration, 2), accelerations += 1;
    }
    sizes.duration = std::max(sizes.duration, double(path.samples()) * path.sample_time);
    if (const MeasuredPort* position = models[i]->record().find("position"))
      sizes.resolution = std::max(sizes.resolution, position->resolution);
  }
  if (!speeds.empty()) {  // a few rows may be disturbed
    const auto top =
        speeds.begin() + std::ptrdiff_t(whole_index(0.995 * double(speeds.size() - 1), speeds.size()));
    std::ranges::nth_element(speeds, top);
    sizes.top_speed = *top;
  }
  sizes.lowest_position = low, sizes.highest_position = high, sizes.stroke = high - low;
  sizes.input_level = std::sqrt(squared_input / std::max(count, 1.0));
  // Of records with masses of their own the least counts: what an effect takes away must be there in each.
  sizes.machine_mass = std::ranges::min(models, {}, &AxisModel::nominal_inertia)->nominal_inertia();
  sizes.machine_damping =
      std::max(0.0, std::ranges::min(models, {}, &AxisModel::nominal_damping)->nominal_damping());
  sizes.force_level = std::sqrt(squared_force / std::max(count, 1.0));
  // An axis that coasts is hardly driven: what slows it down is seen by what it does to its mass.
  const double inertial = std::sqrt(squared_inertial / std::max(accelerations, 1.0));
  if (sizes.force_level < criteria::least_driving_share * inertial) sizes.force_level = inertial;
  sizes.sample_time = divisible(paths.front()->sample_time);
  sizes.start = models.front()->record().start;
  sizes.clocks_differ = std::ranges::any_of(models, [&](const AxisModel* model) {
    return std::abs(model->record().start - sizes.start) > 0.5 * sizes.sample_time;
  });
  return sizes;
}

double shortest_pitch(const RecordSizes& sizes) {
  return criteria::rows_of_shortest_pitch * sizes.top_speed * sizes.sample_time;
}

double fine_pitch(const RecordSizes& sizes) {
  return criteria::rows_of_fine_pitch * sizes.top_speed * sizes.sample_time;
}

}  // namespace loopwright::diagnosis
