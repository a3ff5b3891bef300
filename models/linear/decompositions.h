/// Decompositions of dense matrices, compiled in one place: each takes ten to twenty seconds of compile time
/// in a file.
#pragma once
#include <Eigen/Core>

namespace loopwright {

/// A v = value v, column by column.
struct Eigensystem {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
};
Eigensystem eigensystem(const Eigen::MatrixXd& A);

/// The eigenvalues without the vectors, for half the cost.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A);

/// A = U T U*, T upper triangular, U unitary.
struct Triangularised {
  Eigen::MatrixXcd T, U;
};
Triangularised triangularised(const Eigen::MatrixXd& A);

/// A = U Σ V*, largest values first.
struct LeftSingular {
  Eigen::VectorXd values;
  Eigen::MatrixXcd U;
};
LeftSingular left_singular(const Eigen::MatrixXcd& A);

/// Zero for an empty matrix.
double largest_singular_value(const Eigen::MatrixXcd& G);

/// The Moore-Penrose pseudo-inverse.
Eigen::MatrixXcd pseudo_inverse(const Eigen::MatrixXcd& A);

}  // namespace loopwright
