/// A learned disturbance d(x, v): what a model file holds, and predictions from it.
#pragma once
#include <variant>
#include "models/gp/dense.h"
#include "models/gp/structured.h"

namespace loopwright::gp {

struct Range {
  double low = 0, high = 0;
  double clamp(double x) const { return x < low ? low : x > high ? high : x; }
};

/// Inputs and labels are in SI units.
struct Model {
  Kernel kernel;
  double label_mean = 0;     ///< taken out of the labels before the regression
  double homing_offset = 0;  ///< position reading at the origin of the model; taken out of positions
  double label_lag = 0;      ///< s: labels were moved ahead by this before training
  std::array<Range, 2> trained;
  /// What the samples said: sums where the kernel has structure, else the samples themselves, without mean
  /// and offset.
  std::variant<Statistics, Samples> data;
};

/// Predictions of a model. Positions are relative to the model's origin.
class Posterior {
 public:
  /// Throws std::domain_error when a dense covariance matrix is not positive definite.
  explicit Posterior(const Model& model);
  /// Label mean included.
  double mean(const Point& at) const;
  /// Of the function, without the noise of an observation.
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
