/// Noise of an axis, the corresponding Kalman gains, and its likelihood.
#pragma once
#include <Eigen/Dense>
#include <cmath>
#include <memory>
#include <vector>
#include "tools/diagnose/predict/axis_model.h"

namespace loopwright::diagnosis {

/// Noise on an axis: a white force held over each sample, a slow disturbing force d[k+1] = memory d[k] + step
/// w[k], and white noise on every measured port. Forces are per nominal inertia: they must not be smaller for
/// a model with less inertia.
struct Noise {
  double white = 0;                 ///< force, standard deviation
  double step = 0;                  ///< force
  double memory = 1;                ///< 1: random walk
  std::vector<double> measurement;  ///< of each port

  /// Standard deviation of the slow force; infinite for a random walk.
  double slow() const;
  /// [sample times] In which the slow force falls to 37 %.
  double memory_samples() const { return -1 / std::log(memory); }
  /// The forces on an axis that has `factor` times the nominal inertia.
  Noise at_inertia(double factor) const { return {factor * white, factor * step, memory, measurement}; }
};

/// Steady-state Kalman predictor of the axis with the slow force as the last state.
struct Gains {
  Eigen::MatrixXd K;           ///< (n + 1) × ports
  Eigen::MatrixXd whiten;      ///< ports × ports, lower: whiten · e has unit covariance
  double log_determinant = 0;  ///< of the covariance of e
  double memory = 1;
  /// Of each row, one after the other, where the axis changes from row to row.
  struct Rows {
    std::vector<double> K, whiten, log_determinant;
  };
  std::shared_ptr<const Rows> rows;  ///< null: all rows have the same; then those above are of a typical row
  /// By columns.
  const double* K_at(size_t row) const { return rows ? &rows->K[row * size_t(K.size())] : K.data(); }
  const double* whiten_at(size_t row) const {
    return rows ? &rows->whiten[row * size_t(whiten.size())] : whiten.data();
  }
  double log_determinant_at(size_t row) const { return rows ? rows->log_determinant[row] : log_determinant; }
};

/// Solves the Riccati equation by doubling; where the axis changes from row to row, by a step for each row.
/// `nominal_inertia` scales the noise forces: see Noise.
Gains gains_of(const LinearAxis& axis, const Noise& noise, double nominal_inertia);

/// The gains of an axis with a load that touches and flies, row by row.
class GainSteps {
 public:
  /// `axis` is without the load; see AxisSteps.
  static std::unique_ptr<GainSteps> of(const LinearAxis& axis,
                                       const std::vector<SwitchedSample::Follows>& load, const Noise& noise,
                                       double nominal_inertia);
  virtual ~GainSteps() = default;
  /// Adds those of the next row, and returns its K.
  virtual const double* correct(Gains::Rows& rows) = 0;
  /// To the row after it, with the A of the axis and the load.
  virtual void advance(const Eigen::MatrixXd& A) = 0;
};

}  // namespace loopwright::diagnosis
