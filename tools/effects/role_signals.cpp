#include "tools/effects/role_signals.h"
#include <algorithm>
#include <cmath>

namespace loopwright {

double RoleSample::gain(double sample_time) const {
  return std::isnan(next_velocity) ? acceleration : (next_velocity - velocity) / sample_time;
}
double RoleSample::jerk(double sample_time) const {
  return std::isnan(next_acceleration) ? 0.0 : (next_acceleration - acceleration) / sample_time;
}
GivenSignals RoleSample::given(double sample_time) const {
  return {{position, velocity, gain(sample_time), acceleration, jerk(sample_time), input, force}};
}

size_t RoleSignals::rows() const {
  return std::max({position.size(), velocity.size(), acceleration.size(), input.size(), force.size()});
}

RoleSample RoleSignals::at(size_t row) const {
  const auto value = [row](std::span<const double> column) {
    return row < column.size() ? column[row] : 0.0;
  };
  RoleSample sample{value(position), value(velocity), value(acceleration), value(input), value(force)};
  sample.velocity_bow = value(velocity_bow);
  if (looks_ahead && row + 1 < velocity.size()) sample.next_velocity = velocity[row + 1];
  if (looks_ahead && row + 1 < acceleration.size()) sample.next_acceleration = acceleration[row + 1];
  return sample;
}

}  // namespace loopwright
