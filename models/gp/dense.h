/// Gaussian-process regression with the full covariance matrix: O(N³) once, O(N) per mean, O(N²) per
/// variance. It is the reference for the structured method, and the fallback where that method does not
/// apply.
#pragma once
#include "models/gp/kernel.h"

namespace loopwright::gp {

/// log p = -½ yᵀ(K + σ_n² I)⁻¹y - ½ log|K + σ_n² I| - N/2 log 2π. The value is -infinity when the matrix is
/// not positive definite in double precision.
Evidence dense_evidence(const Kernel& kernel, const Samples& samples);

class DensePosterior {
 public:
  /// Throws std::domain_error when K + σ_n² I is not positive definite in double precision.
  DensePosterior(Kernel kernel, const Samples& samples);
  double mean(const Point& at) const;
  /// Variance of the function, without the observation noise; never below 0.
  double variance(const Point& at) const;
  /// The contribution of one term to the mean.
  Jet term(size_t index, const Point& at) const;
  /// ‖f_t‖ σ_t, see derivative_bound(); O(N²).
  double term_norm(size_t index) const;
  /// Σ |w_i|: |f_t| ≤ σ_t² Σ |w_i| c.
  double weight_sum() const;

 private:
  Kernel kernel_;
  std::vector<Point> inputs_;
  std::vector<double> weights_;  ///< (K + σ_n² I)⁻¹ y
  std::vector<double> root_;     ///< lower Cholesky factor, column by column
};

}  // namespace loopwright::gp
