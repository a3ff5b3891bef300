/// Frequency responses of linear systems.
#pragma once
#include "models/linear/state_space.h"

namespace loopwright {

/// G at s = jω of a continuous system, with exact delays, or at z = e^(jωT) of a sampled one. One reduction
/// to triangular form; then each frequency costs n² operations.
///
/// A system of `lifted` samples in a period responds to a sine with this sine and with others, folded at the
/// period. The result is the component at the frequency of the input.
class FrequencyResponse {
 public:
  explicit FrequencyResponse(const StateSpace& system, int lifted = 1);
  /// Outputs by inputs; `frequency` in rad/s.
  Eigen::MatrixXcd at(double frequency) const;
  /// The Nyquist frequency, rad/s; infinity for a continuous system.
  double nyquist() const;

 private:
  Eigen::MatrixXcd transfer(std::complex<double> point) const;
  StateSpace system_;
  int lifted_;
  Eigen::MatrixXcd T_, B_, C_;
};

}  // namespace loopwright
