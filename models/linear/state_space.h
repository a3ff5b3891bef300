/// Linear systems with constant coefficients, as four matrices.
#pragma once
#include <Eigen/Core>
#include <complex>
#include <vector>

namespace loopwright {

/// Continuous, with sample_time 0:  x' = A x + B u,  y = C x + D u.
/// Sampled:  x[k+1] = A x[k] + B u[k],  y[k] = C x[k] + D u[k].
///
/// Delays of a continuous system are channels of their own: its last inputs are what the last outputs were
/// `delays[i]` seconds ago, in the same order. What is left are the inputs and outputs proper.
struct StateSpace {
  Eigen::MatrixXd A, B, C, D;
  double sample_time = 0;      ///< s; 0: continuous
  std::vector<double> delays;  ///< s; of a continuous system

  Eigen::Index states() const { return A.rows(); }
  Eigen::Index inputs() const { return B.cols() - Eigen::Index(delays.size()); }
  Eigen::Index outputs() const { return C.rows() - Eigen::Index(delays.size()); }
};

/// The system with every delay replaced by Padé's approximation with a numerator one degree below the
/// denominator, so that nothing passes at once. It is good to 1 % in gain and phase up to about ω τ = order.
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
/// exact but for rounding, also for singular A.
Propagation propagate(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, double duration);

/// The sampled system that a continuous one is to who writes its inputs through a zero-order hold and reads
/// its outputs at the same samples, T seconds apart. Exact. Throws std::invalid_argument for a system with
/// delays: replace them by `with_approximate_delays` first.
StateSpace hold_discretization(const StateSpace& system, double sample_time);

}  // namespace loopwright
