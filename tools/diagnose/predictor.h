/// One-step predictions of the measured signals by the user's own diagram, and how they answer to further
/// forces.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>
#include "tools/diagnose/axis_model.h"
#include "tools/diagnose/noise.h"

namespace loopwright::diagnosis {

/// What the model is driven with, a value each sample: means over the sample of the input and of `force`,
/// which pushes backward (it is what effects consume); `sensor` is added to the predicted position. Slopes
/// are changes within the sample, see Column; empty: none.
struct Drives {
  std::vector<double> input, force, sensor;
  std::vector<double> input_slope, force_slope;
};

/// The motion as the predictor saw it: position and velocity at the start of each sample, the acceleration
/// predicted for it. They are functions of the past alone, so that nothing computed from them correlates with
/// the noise to come.
struct Path {
  uint64_t identity =
      0;  ///< equal only for equal paths, as what was computed along one is remembered; 0: none
  double sample_time = 0;
  std::vector<double> position, velocity, acceleration, input;
  std::vector<double> force;               ///< what the recorded input makes of force
  std::vector<double> predicted_position;  ///< before the sample itself was measured
  std::vector<char> rests;                 ///< slower than `rest_speed`
  /// For some samples after a reversal. Dry friction turns there, at a moment that is known to a sample or
  /// two, and what it does meanwhile is no slow force. Nor is what happened while samples were missing.
  std::vector<char> turns;
  double rest_speed = 0;
  size_t samples() const { return rests.size(); }
  /// No slow force is believed.
  bool forgets(size_t sample) const { return rests[sample] || turns[sample]; }
  /// Another path, as far as the first has been followed.
  Path first_samples(size_t count) const;
};

/// The balances of a map, as far as wanted. From each the axis creeps on toward the next, so slowly that only
/// the direction counts.
Path creep_along(const AxisRecord& map, size_t rows);

struct Prediction {
  std::vector<double> error;  ///< samples × ports: measured minus predicted
  std::vector<double> slow;   ///< of each sample: the disturbing force believed after measuring
  Path path;
};

/// As long as the predictor takes to correct a blow, or what friction on the wrong side has done.
constexpr int samples_to_correct = 15;

/// Steps the diagram along the record, as far as the drives go: correct with what was measured, predict the
/// next sample.
Prediction predict(AxisModel& model, const LinearAxis& axis, const Gains& gains, const Drives& drives,
                   double rest_speed);

/// The errors that other gains would have made on the same record, without stepping the diagram again.
std::vector<double> with_gains(const LinearAxis& axis, const Prediction& prediction, const Gains& from,
                               const Gains& to);

/// z[k] = whiten · e[k], in place.
void whiten(std::vector<double>& error, const Gains& gains);

/// Where an effect acts.
enum class Acts {
  force,   ///< consumes a force
  input,   ///< replaces the input by another one
  sensor,  ///< adds an error to the measured position
};

/// What is consumed, or added to the measured position: a mean over each sample, and how much more at its end
/// than at its start, as far as that moves the axis (see EffectRun). No slope: null. Copies share the
/// numbers.
struct Column {
  using Numbers = std::shared_ptr<const std::vector<float>>;
  Numbers mean, slope;

  Column() = default;
  explicit Column(std::vector<float> mean_, std::vector<float> slope_ = {})
      : mean(std::make_shared<const std::vector<float>>(std::move(mean_))) {
    if (!slope_.empty()) slope = std::make_shared<const std::vector<float>>(std::move(slope_));
  }
};
/// Columns of an effect at given nonlinear parameters, per unit of each linear parameter.
using Columns = std::vector<Column>;

/// What each column adds to the whitened errors, samples × ports; eight at a time are as fast as two alone.
std::vector<std::vector<double>> responses(const LinearAxis& axis, const Gains& gains, const Path& path,
                                           Acts acts, std::span<const Column* const> columns);
/// The same at some rows, ascending, each with its ports, written from to[column] on.
void responses(const LinearAxis& axis, const Gains& gains, const Path& path, Acts acts,
               std::span<const Column* const> columns, std::span<const size_t> rows,
               std::span<double* const> to);
std::vector<const Column*> pointers(const Columns& columns);

}  // namespace loopwright::diagnosis
