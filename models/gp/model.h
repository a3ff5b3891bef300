/// A learned disturbance d(x, v): the contents of a model file, and predictions from it.
#pragma once
#include <variant>
#include "models/gp/dense.h"
#include "models/gp/structured.h"

namespace loopwright::gp {

struct Range {
  double low = 0, high = 0;
  double clamp(double x) const { return x < low ? low : x > high ? high : x; }
};

/// A trained model. Inputs and labels are in SI units.
struct Model {
  Kernel kernel;
  double label_mean = 0;     ///< subtracted from the labels before the regression
  double homing_offset = 0;  ///< position reading at the origin of the model; subtracted from positions
  double label_lag = 0;      ///< s: labels were advanced by this before training
  std::array<Range, 2> trained;
  /// The training data: statistics if the kernel has structure, otherwise the samples themselves, without
  /// mean and offset.
  std::variant<Statistics, Samples> data;
};

/// Predictions of a model. Positions are relative to the model's origin.
class Posterior {
 public:
  /// Throws std::domain_error when a dense covariance matrix is not positive definite.
  explicit Posterior(const Model& model);
  /// Posterior mean, label mean included.
  double mean(const Point& at) const;
  /// Variance of the function, without the observation noise.
  double variance(const Point& at) const;

  const std::vector<Term>& terms() const { return terms_; }
  double label_mean() const { return label_mean_; }
  Jet term(size_t index, const Point& at) const;
  double term_norm(size_t index) const;
  double weight_sum() const;
  const std::array<Range, 2>& trained() const { return trained_; }

 private:
  std::vector<Term> terms_;
  double label_mean_;
  std::array<Range, 2> trained_;
  std::variant<StructuredPosterior, DensePosterior> solved_;
};

}  // namespace loopwright::gp
