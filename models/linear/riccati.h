/// Quadratic regulators and Kalman filters: algebraic Riccati equations, continuous and sampled.
#pragma once
#include <string>
#include <vector>
#include "models/linear/poles.h"

namespace loopwright {

/// Continuous: ∫ xᵀQx + 2xᵀNu + uᵀRu dt. Sampled: the sum of the same over the samples. R must be positive
/// definite, [Q N; Nᵀ R] positive semidefinite.
struct QuadraticCost {
  Eigen::MatrixXd Q, R, N;  ///< states by states, inputs by inputs, states by inputs
};

struct Regulator {
  Eigen::MatrixXd K;        ///< u = -K x
  Eigen::MatrixXd X;        ///< xᵀXx is the cost from x on
  std::vector<Pole> poles;  ///< of A - B K
  double residual = 0;      ///< of the Riccati equation, relative to its largest term (Frobenius norms)
};

/// A mode that prevents a regulator.
struct Obstacle {
  enum class Kind {
    uncontrollable,  ///< unstable or on the boundary of stability, and no input reaches it
    free,            ///< on the boundary of stability, and the cost does not see it
    ill_conditioned  ///< none of both to working accuracy, but there is no accurate solution
  };
  Kind kind;
  Pole mode;  ///< of A; `participation`: of the states in the directions that are not reached, or not seen
};

/// What stands against a regulator of the system (its C, D and delays are ignored). Empty: nothing does. The
/// test is that of Popov, Belevitch and Hautus: the smallest singular value of [A - λ, B], or of [A - λ; Q],
/// in balanced coordinates and relative to the largest one.
std::vector<Obstacle> obstacles(const StateSpace& system, const QuadraticCost& cost);

/// The optimal regulator. Continuous: the stable invariant subspace of the Hamiltonian matrix from its
/// ordered Schur form (A. J. Laub, IEEE Trans. Automatic Control 24, 1979). Sampled: structure-preserving
/// doubling (models/signal/riccati_doubling.h), which allows a singular A, such as that of a delay. Returns
/// no poles if there is none, or no accurate one; `obstacles` tells why.
Regulator regulator(const StateSpace& system, const QuadraticCost& cost);

/// The dual problem, a filter for x' = A x + w, y = C x + v with noise of the intensities Q, R and N = E[w
/// vᵀ]: the cost is that of the transposed system.
struct Filter {
  Eigen::MatrixXd gain;  ///< continuous: x̂' = A x̂ + B u + gain (y - ŷ). Sampled: correction at the sample.
  Eigen::MatrixXd predictor;  ///< sampled: x̂[k+1] = A x̂[k] + B u[k] + predictor (y[k] - ŷ[k])
  Eigen::MatrixXd P;          ///< covariance of the error; sampled: before the correction
  std::vector<Pole> poles;    ///< of the error; empty: there is no filter
  double residual = 0;        ///< as for a regulator
};
Filter filter(const StateSpace& system, const QuadraticCost& noise);

/// The system whose regulator is the filter.
StateSpace dual(const StateSpace& system);

}  // namespace loopwright
