/// How a linear system answers sines.
#pragma once
#include "models/linear/state_space.h"

namespace loopwright {

/// G at s = jω of a continuous system, its delays exact, or at z = e^(jωT) of a sampled one. After one
/// reduction to triangular form every frequency costs n² operations.
///
/// A system of `lifted` samples in a period answers a sine with that sine and others, folded at the period:
/// what is given is the share of the sine itself.
class FrequencyResponse {
 public:
  explicit FrequencyResponse(const StateSpace& system, int lifted = 1);
  /// Outputs by inputs; `frequency` in rad/s.
  Eigen::MatrixXcd at(double frequency) const;
  /// The largest frequency that samples can tell from smaller ones, rad/s; infinity for a continuous system.
  double nyquist() const;

 private:
  Eigen::MatrixXcd transfer(std::complex<double> point) const;
  StateSpace system_;
  int lifted_;
  Eigen::MatrixXcd T_, B_, C_;
};

/// `count` frequencies (rad/s), equally spaced in their logarithm from a decade below the slowest pole to a
/// decade above the fastest, or to Nyquist's, and more of them around every lightly damped pole.
std::vector<double> interesting_frequencies(const StateSpace& system, int count, int lifted = 1);

}  // namespace loopwright
