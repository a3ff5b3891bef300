/// The force that the model lacks, where it occurs, and on what it depends.
#pragma once
#include <string>
#include "tools/compare/machine.h"

namespace loopwright {

/// r = driving force - (force that the model needs for the measured motion): positive where the machine needs
/// more. Everything is in the unit of the summed forces, whatever the unit of the input.
struct ForceResidual {
  std::vector<double> value;    ///< [force] below `cutoff`, at every row of the motion
  double cutoff = 0;            ///< [Hz]
  double rmse = 0;              ///< [force] over the rows that count
  double relative_percent = 0;  ///< of the rms of the driving force
  double noise_floor = 0;       ///< [force] no model could explain less
  std::string floor_source;     ///< origin of the noise floor, as text
  double repeat_s = 0;          ///< [s] period of the motion; 0: it does not repeat
};

/// A part of the record and its share of the squared residual.
struct ResidualShare {
  std::string axis;   ///< segment, position, velocity, direction, acceleration, input, time, …
  std::string label;  ///< of a segment or direction; else empty
  double from = 0, to = 0;
  double share = 0;    ///< of the squared residual, 0 to 1
  double of_rows = 0;  ///< fraction of the rows that count
};

/// How much of the residual beside a constant a function of one variable explains, on blocks of the record
/// that it was not fitted to. The share explained by chance alone counts as zero. The share of the variable
/// "offset" is that of the constant in the squared residual.
struct Dependence {
  std::string variable;
  double share = 0;      ///< 0 to 1
  double by_chance = 0;  ///< the largest share for residuals of random sign per block
  double at = 0;         ///< frequency of the strongest line: [1/position] or [Hz]; else 0
};

/// What noise alone would leave of a residual force, seen without a model.
struct NoiseFloor {
  double value = 0, repeat_s = 0;  ///< repeat_s: after which the motion repeats; 0: it does not
  std::string source;
};
/// Half of the spread between repeats of the motion, else what smooth functions of the motion leave.
NoiseFloor noise_floor(const MeasuredMotion& motion, const std::vector<double>& residual);

/// `acceleration`: of the model, over each sample (model_acceleration).
ForceResidual force_residual(const Machine& machine, const std::vector<double>& acceleration);

std::vector<ResidualShare> where_it_lies(const Machine& machine, const ForceResidual& residual);
std::vector<Dependence> dependences(const Machine& machine, const ForceResidual& residual);

/// Segment of a row's motion: rest, acceleration, constant speed, deceleration, reversal.
enum class Segment : uint8_t { rest, acceleration, constant_speed, deceleration, reversal };
std::vector<Segment> segments(const MeasuredMotion& motion);
std::string_view name_of(Segment segment);

}  // namespace loopwright
