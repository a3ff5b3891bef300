/// The motion of a machine as a record shows it.
#pragma once
#include <string>
#include <vector>

namespace loopwright {

/// The measured signals on a uniform grid, filtered without phase shift.
struct MeasuredMotion {
  double start = 0, sample_time = 0;  ///< [s]
  std::vector<double> time;           ///< [s]
  std::vector<char> missing;          ///< samples without a row in the record; empty: none
  std::vector<double> raw_position;   ///< as recorded; integrated if only the velocity was measured
  std::vector<double> position, velocity, acceleration;  ///< below the cut-off; central differences
  std::vector<double> input;                             ///< its mean from each sample to the next
  /// The force produced by the input, according to the model, where the forces are summed: see
  /// driving_force().
  std::vector<double> force;
  std::string position_unit, input_unit, force_unit;  ///< SI
  double cutoff = 0;                                  ///< [Hz] of position
  double rest_speed = 0;                              ///< [position/s] below it the machine counts as at rest
  std::vector<char> counts;  ///< rows away from rest, from missing samples and from the ends

  size_t rows() const { return time.size(); }
  bool is_missing(size_t row) const { return !missing.empty() && missing[row]; }
  double stroke() const;
  double top_speed() const;
};

/// Position, velocity and acceleration below the cut-off, and the rows that count: from the raw position, or
/// from the measured velocity if there is no position. Sample time and time must be set.
void smooth_motion(MeasuredMotion& motion);

/// Moves all positions. The integral of a measured velocity begins at zero, which may not be where the
/// machine was.
void shift_position(MeasuredMotion& motion, double by);

}  // namespace loopwright
