/// Regression from statistics instead of samples: exact to rounding, at a cost that does not depend on N.
///
/// With features Φ (N×m) and a kernel K = Φ S Φᵀ, S = L Lᵀ, everything follows from G = ΦᵀΦ and b = Φᵀy by
/// the matrix inversion and determinant lemmas (Rasmussen, Williams 2006, appendix A.3):
///   B = I + LᵀGL/σ_n²,   log|K + σ_n² I| = N log σ_n² + log|B|,
///   Φᵀ(K + σ_n² I)⁻¹Φ = (G - GL B⁻¹LᵀG/σ_n²)/σ_n²
#pragma once
#include <memory>
#include "models/gp/statistics.h"
#include "models/gp/term_features.h"

namespace loopwright::gp {

/// Evaluates one set of statistics for many hyper-parameters.
class StructuredEvidence {
 public:
  explicit StructuredEvidence(const Statistics& statistics);
  ~StructuredEvidence();
  /// See dense_evidence(). The kernel must have the structure for which the statistics were made.
  Evidence operator()(const Kernel& kernel);

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

class StructuredPosterior {
 public:
  StructuredPosterior(const Kernel& kernel, const Statistics& statistics);
  double mean(const Point& at) const;
  /// Variance of the function, without the observation noise; never below 0.
  double variance(const Point& at) const;
  /// As in DensePosterior.
  Jet term(size_t index, const Point& at) const;
  double term_norm(size_t index) const { return terms_[index].norm; }
  /// An upper bound, √N ‖w‖, with w = (y - mean)/σ_n² of the samples.
  double weight_sum() const { return weight_sum_; }
  /// Root mean square of y - mean over the samples.
  double residual_rms() const { return residual_rms_; }

 private:
  std::vector<TermFeatures> terms_;
  double prior_ = 0, weight_sum_ = 0, residual_rms_ = 0;
  size_t functions_ = 0;
  std::vector<double> precision_;  ///< Φᵀ(K + σ_n² I)⁻¹Φ, symmetric
};

}  // namespace loopwright::gp
