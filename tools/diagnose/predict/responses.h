/// Responses of the one-step predictions to additional forces.
#pragma once
#include <memory>
#include <span>
#include <vector>
#include "tools/diagnose/predict/predictor.h"

namespace loopwright::diagnosis {

/// Of a load that is a state of the predictor and flies: a position and a velocity.
constexpr int most_load_states = 2;

/// Where an effect acts.
enum class Acts {
  force,   ///< consumes a force
  input,   ///< replaces the input
  sensor,  ///< adds an error to the measured position
};

/// The consumed force, or the error added to the measured position: a mean over each sample, and the change
/// from its start to its end, as far as that moves the axis (see EffectRun). No slope: null. Copies share the
/// numbers.
struct Column {
  using Numbers = std::shared_ptr<const std::vector<float>>;
  Numbers mean, slope;
  std::vector<Numbers> load;  ///< what the states of a load that flies change over a sample; empty: nothing

  Column() = default;
  explicit Column(std::vector<float> mean_, std::vector<float> slope_ = {})
      : mean(std::make_shared<const std::vector<float>>(std::move(mean_))) {
    if (!slope_.empty()) slope = std::make_shared<const std::vector<float>>(std::move(slope_));
  }
};
/// Columns of an effect at given nonlinear parameters, per unit of each linear parameter.
using Columns = std::vector<Column>;

/// What each column adds to the whitened errors, samples × ports; eight together cost as much as two alone.
std::vector<std::vector<double>> responses(const LinearAxis& axis, const Gains& gains, const Path& path,
                                           Acts acts, std::span<const Column* const> columns);
/// The same at some rows, ascending, each with its ports, written from to[column] on.
void responses(const LinearAxis& axis, const Gains& gains, const Path& path, Acts acts,
               std::span<const Column* const> columns, std::span<const size_t> rows,
               std::span<double* const> to);
std::vector<const Column*> pointers(const Columns& columns);

}  // namespace loopwright::diagnosis
