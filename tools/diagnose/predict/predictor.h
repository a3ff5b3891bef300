/// One-step predictions of the measured signals by the user's own diagram.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>
#include "tools/diagnose/predict/axis_model.h"
#include "tools/diagnose/predict/noise.h"

namespace loopwright::diagnosis {

struct Path;

/// The inputs of the model, one value per sample: means over the sample of the input and of `force`, which
/// pushes backward (effects consume it); `sensor` is added to the predicted position. Slopes are changes
/// within the sample, see Column; empty: none.
struct Drives {
  std::vector<double> input, force, sensor;
  std::vector<double> input_slope, force_slope;
  const Path* along = nullptr;  ///< the motion along which the forces are
};

/// The motion as estimated by the predictor: position and velocity at the start of each sample, and the
/// predicted acceleration. They are functions of the past alone, so nothing computed from them correlates
/// with future noise.
struct Path {
  uint64_t identity = 0;  ///< equal only for equal paths, because results along a path are cached; 0: none
  static uint64_t next_identity();  ///< that no path has yet
  double sample_time = 0;
  std::vector<double> position, velocity, acceleration, input;
  /// Of each sample: by how much its predicted mean velocity exceeds the middle between the velocities at its
  /// ends. With few rows in a motion, or much damping, a straight line is no longer close enough.
  std::vector<double> velocity_bow;
  std::vector<double> input_slope;         ///< of the recorded input; empty: held
  std::vector<double> duration;            ///< [sample times] of each sample; empty: 1
  std::vector<double> force;               ///< the force produced by the recorded input
  std::vector<double> predicted_position;  ///< before the measurement of the sample itself
  std::vector<char> rests;                 ///< slower than Pace::rest_speed
  /// For some samples after a reversal. There dry friction changes sign, at an instant known only to within a
  /// sample or two, and its force then is no slow force. The same holds for missing samples.
  std::vector<char> turns;
  size_t samples() const { return rests.size(); }
  /// No slow force is estimated.
  bool forgets(size_t sample) const { return rests[sample] || turns[sample]; }
  /// Another path, over the rows that the first one covers.
  Path first_samples(size_t count) const;
};

/// The balances of a map, as far as requested. From each balance the axis creeps to the next, so slowly that
/// only the direction matters.
Path creep_along(const AxisRecord& map, size_t rows);

struct Prediction {
  std::vector<double> error;  ///< samples × ports: measured minus predicted
  std::vector<double> slow;   ///< of each sample: the disturbing force estimated after measuring
  Path path;
};

/// The waits of a record: see criteria.h.
struct Pace {
  double rest_speed = 0;       ///< [position/s]
  int samples_to_correct = 1;  ///< until an impact, or friction of the wrong sign, is corrected
  int samples_after_rest = 1;  ///< until the slow force is known again
};

/// [samples] The slowest time constant in which the predictor corrects position and velocity.
double correction_time(const LinearAxis& axis, const Gains& gains);

class FlyingLoad;

/// Steps the diagram along the record, as far as the drives extend: correct with the measurement, predict the
/// next sample.
Prediction predict(AxisModel& model, const LinearAxis& axis, const Gains& gains, const Drives& drives,
                   const Pace& pace);
/// The same with a load whose force the drives do not contain. It brings its gains.
Prediction predict(AxisModel& model, const LinearAxis& axis, const Drives& drives, const Pace& pace,
                   FlyingLoad& load);

/// The errors that other gains would give on the same record, without stepping the diagram again.
void with_gains(const LinearAxis& axis, const Prediction& prediction, const Gains& from, const Gains& to,
                std::vector<double>& error);

/// z[k] = whiten · e[k], in place.
void whiten(std::vector<double>& error, const Gains& gains);

}  // namespace loopwright::diagnosis
