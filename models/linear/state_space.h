/// Linear systems with constant coefficients, as four matrices.
#pragma once
#include <Eigen/Core>
#include <complex>
#include <vector>

namespace loopwright {

/// Continuous, with sample_time 0:  x' = A x + B u,  y = C x + D u.
/// Sampled:  x[k+1] = A x[k] + B u[k],  y[k] = C x[k] + D u[k].
///
/// Delays of a continuous system are separate channels: its last inputs are its last outputs delayed by
/// `delays[i]` seconds, in the same order. The remaining channels are the actual inputs and outputs.
struct StateSpace {
  Eigen::MatrixXd A, B, C, D;
  double sample_time = 0;      ///< s; 0: continuous
  std::vector<double> delays;  ///< s; of a continuous system

  Eigen::Index states() const { return A.rows(); }
  Eigen::Index inputs() const { return B.cols() - Eigen::Index(delays.size()); }
  Eigen::Index outputs() const { return C.rows() - Eigen::Index(delays.size()); }
};

/// The system with every delay replaced by a Padé approximation. Its numerator has one degree less than its
/// denominator, so that it has no direct feedthrough. It is accurate to 1 % in gain and phase up to about ω τ
/// = order.
StateSpace with_approximate_delays(const StateSpace& system, int order);

/// One input to one output of a system.
StateSpace channel(const StateSpace& system, Eigen::Index input, Eigen::Index output);

/// u → first → second → y.
StateSpace in_series(const StateSpace& first, const StateSpace& second);

/// y = (first + sign · second) u.
StateSpace in_parallel(const StateSpace& first, const StateSpace& second, double sign = 1);

/// x(t + T) = transition · x(t) + input · u with u constant over T.
struct Propagation {
  Eigen::MatrixXd transition;  ///< e^(A T)
  Eigen::MatrixXd input;       ///< ∫ e^(A s) ds B, s from 0 to T
};

/// Both from one matrix exponential of [A B; 0 0] T (C. F. Van Loan, IEEE Trans. Automatic Control 23, 1978);
/// exact except for rounding, also for singular A.
Propagation propagate(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, double duration);

/// The exact sampled equivalent of a continuous system whose inputs come through a zero-order hold and whose
/// outputs are read at the same samples, T seconds apart. Throws std::invalid_argument for a system with
/// delays: replace them by `with_approximate_delays` first.
StateSpace hold_discretization(const StateSpace& system, double sample_time);

}  // namespace loopwright
