/// The signals of a record, by the roles under which an effect reads them.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace loopwright {

/// What an effect is given at the start of a sample. Within it the position is a parabola, velocity and
/// acceleration are straight lines; input and force are held.
struct GivenSignals {
  enum Index { position, velocity, velocity_slope, acceleration, acceleration_slope, input, force, count };
  std::array<double, count> value{};
  double operator[](Index i) const { return value[i]; }
};

/// The signals that the effect may read at one sample; roles that it does not read are ignored.
struct RoleSample {
  double position = 0, velocity = 0, acceleration = 0, input = 0, force = 0;
  /// At the next sample; NaN: the velocity is extrapolated with constant acceleration. Leave it NaN if the
  /// value must not depend on later measurements.
  double next_velocity = std::numeric_limits<double>::quiet_NaN();
  double next_acceleration = std::numeric_limits<double>::quiet_NaN();
  double velocity_bow = 0;  ///< see RoleSignals

  /// Slopes of velocity and acceleration within a sample [s].
  double gain(double sample_time) const {
    return std::isnan(next_velocity) ? acceleration : (next_velocity - velocity) / sample_time;
  }
  double jerk(double sample_time) const {
    return std::isnan(next_acceleration) ? 0.0 : (next_acceleration - acceleration) / sample_time;
  }
  GivenSignals given(double sample_time) const {
    return {{position, velocity, gain(sample_time), acceleration, jerk(sample_time), input, force}};
  }
};

/// Columns of a record, or of a predictor; empty if the effect does not read them.
struct RoleSignals {
  std::span<const double> position, velocity, acceleration, input, force;
  /// True: within a sample velocity and acceleration are interpolated to those of the next sample, which is
  /// best for an analysis of the whole record. False: they are extrapolated from velocity and acceleration,
  /// so that row k depends only on rows up to k.
  bool looks_ahead = false;
  /// By how much the mean velocity of a sample exceeds the middle between those at its ends; empty: straight
  /// lines.
  std::span<const double> velocity_bow;

  size_t rows() const {
    return std::max({position.size(), velocity.size(), acceleration.size(), input.size(), force.size()});
  }
  RoleSample at(size_t row) const {
    const auto value = [row](std::span<const double> column) {
      return row < column.size() ? column[row] : 0.0;
    };
    RoleSample sample{value(position), value(velocity), value(acceleration), value(input), value(force)};
    sample.velocity_bow = value(velocity_bow);
    if (looks_ahead && row + 1 < velocity.size()) sample.next_velocity = velocity[row + 1];
    if (looks_ahead && row + 1 < acceleration.size()) sample.next_acceleration = acceleration[row + 1];
    return sample;
  }
};

}  // namespace loopwright
