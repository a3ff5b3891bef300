/// Loads that effects hang on the axis, as states of the predictor: an error of the estimated motion moves
/// them too, and they push back. Coarse counts or a loud sensor would otherwise shake a load along its path
/// that no measurement ever corrects.
#pragma once
#include "tools/diagnose/predict/predictor.h"
#include "tools/effects/linear_effect.h"

namespace loopwright::diagnosis {

/// The axis with one more load: its states follow those that there are, as deviations from the motion that
/// the load has along the path on which the effect ran. Unchanged if position or velocity is no state of the
/// axis. `load`: all its parameters as fitted. Its force within a sample enters by its mean.
LinearAxis with_load(LinearAxis axis, const SampleMap& load);

/// What these loads do along a record besides what they do along the path on which the effects ran.
class LoadDeviation {
 public:
  /// `along`: that path; null: there are no loads.
  LoadDeviation(const LinearAxis& axis, const Path* along);
  /// By the error of a measured port, and its column of the gains.
  void correct(const double* gains, double error);
  /// The force consumed over the sample that begins at a row, there with this motion.
  double force(size_t row, double position, double velocity);

 private:
  const LinearAxis& axis_;
  const Path* along_;
  Eigen::Index own_;
  Eigen::MatrixXd onward_;
  Eigen::VectorXd state_;  // of the axis: from the path; of the loads: from their motion along it
  Eigen::VectorXd next_;
};

}  // namespace loopwright::diagnosis
