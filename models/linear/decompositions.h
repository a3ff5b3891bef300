/// Decompositions of dense matrices, compiled once for all: each costs a compiler ten to twenty seconds a
/// file.
#pragma once
#include <Eigen/Core>

namespace loopwright {

/// A v = value v, column by column.
struct Eigensystem {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
};
Eigensystem eigensystem(const Eigen::MatrixXd& A);

/// The same values without their vectors, for half of the work.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A);

/// A = U T U*, T upper triangular, U unitary.
struct Triangularised {
  Eigen::MatrixXcd T, U;
};
Triangularised triangularised(const Eigen::MatrixXd& A);

/// Zero for an empty matrix.
double largest_singular_value(const Eigen::MatrixXcd& G);

/// Moore and Penrose's.
Eigen::MatrixXcd pseudo_inverse(const Eigen::MatrixXcd& A);

}  // namespace loopwright
