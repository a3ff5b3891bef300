#include "models/linear/decompositions.h"
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>

namespace loopwright {

Eigensystem eigensystem(const Eigen::MatrixXd& A) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A) {
  return Eigen::EigenSolver<Eigen::MatrixXd>(A, false).eigenvalues();
}

Triangularised triangularised(const Eigen::MatrixXd& A) {
  const Eigen::ComplexSchur<Eigen::MatrixXd> schur(A);
  return {schur.matrixT(), schur.matrixU()};
}

LeftSingular left_singular(const Eigen::MatrixXcd& A) {
  const Eigen::JacobiSVD<Eigen::MatrixXcd, Eigen::FullPivHouseholderQRPreconditioner> svd(
      A, Eigen::ComputeFullU);
  return {svd.singularValues(), svd.matrixU()};
}

double largest_singular_value(const Eigen::MatrixXcd& G) {
  return G.size() == 0 ? 0.0 : Eigen::JacobiSVD<Eigen::MatrixXcd>(G).singularValues()[0];
}

Eigen::MatrixXcd pseudo_inverse(const Eigen::MatrixXcd& A) {
  return A.completeOrthogonalDecomposition().pseudoInverse();
}

}  // namespace loopwright
