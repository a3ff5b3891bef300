/// The force that the model lacks, where it shows, and on what it depends.
#pragma once
#include <string>
#include "tools/compare/machine.h"

namespace loopwright {

/// r = driving force - (force that the model needs for the measured motion): positive where the machine takes
/// more. All in the unit of the place where the forces add up, whatever the unit of the input.
struct ForceResidual {
  std::vector<double> value;    ///< [force] below `cutoff`, at every row of the motion
  double cutoff = 0;            ///< [Hz]
  double rmse = 0;              ///< [force] over the rows that count
  double relative_percent = 0;  ///< of the rms of the driving force
  double noise_floor = 0;       ///< [force] what no model could explain
  std::string floor_source;     ///< where the floor comes from, in words
  double repeat_s = 0;          ///< [s] after which the motion repeats; 0: it does not
};

/// A part of the record and its part of the squared residual.
struct ResidualShare {
  std::string axis;   ///< segment, position, velocity, direction, acceleration, input, time, …
  std::string label;  ///< of a segment or direction; else empty
  double from = 0, to = 0;
  double share = 0;    ///< of the squared residual, 0 to 1
  double of_rows = 0;  ///< part of the rows that count
};

/// How much of the residual a function of one variable explains, on blocks of the record that it was not
/// fitted to; what chance alone explains counts as nothing.
struct Dependence {
  std::string variable;
  double share = 0;      ///< 0 to 1
  double by_chance = 0;  ///< the most that residuals of random sign per block gave
  double at = 0;         ///< frequency of the strongest line: [1/position] or [Hz]; else 0
};

/// `acceleration`: of the model, over each sample (model_acceleration).
ForceResidual force_residual(const Machine& machine, const std::vector<double>& acceleration);

std::vector<ResidualShare> where_it_lies(const Machine& machine, const ForceResidual& residual);
std::vector<Dependence> dependences(const Machine& machine, const ForceResidual& residual);

/// Part of a row's motion: rest, acceleration, constant speed, deceleration, reversal.
enum class Segment : uint8_t { rest, acceleration, constant_speed, deceleration, reversal };
std::vector<Segment> segments(const MeasuredMotion& motion);
std::string_view name_of(Segment segment);

}  // namespace loopwright
