#include "tools/diagnose/search/elimination.h"
#include <algorithm>
#include <cmath>

namespace loopwright::diagnosis {
namespace {

/// [of a squared column] Keeps columns that others replace from dividing by nothing.
constexpr double relative_ridge = 1e-9;
double scale_of(double square) { return 1 / std::sqrt(std::max(square, 1e-300)); }

}  // namespace

Solved solve(const Products& G, std::vector<int> columns, const Eigen::VectorXd& b, double squares) {
  Solved result{std::move(columns), squares, {}, {}, {}, {}};
  const std::vector<int>& c = result.columns;
  if (c.empty()) return result;
  result.scale = Eigen::VectorXd(G.diagonal())(c).unaryExpr(&scale_of);
  result.products = result.scale.asDiagonal() * G(c, Eigen::all);
  Eigen::MatrixXd own = result.products(Eigen::all, c) * result.scale.asDiagonal();
  own.diagonal().array() += relative_ridge;
  const Eigen::LDLT<Eigen::MatrixXd> factor(own);
  const Eigen::VectorXd right = result.scale.cwiseProduct(b(c));
  result.theta = factor.solve(right);
  result.solved = factor.solve(result.products);
  result.squares -= right.dot(result.theta);
  return result;
}

Added add(const Products& G, const std::vector<int>& columns, const Solved& to, const Eigen::VectorXd& b) {
  const Eigen::Index n = Eigen::Index(columns.size());
  const bool is_alone = to.columns.empty();
  Eigen::MatrixXd own(n, n);
  Eigen::VectorXd right(n), scale(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const int column = columns[size_t(i)];
    scale[i] = scale_of(G(column, column));
    right[i] = scale[i] * (b[column] - (is_alone ? 0.0 : to.products.col(column).dot(to.theta)));
    for (Eigen::Index j = 0; j <= i; ++j) {
      const int other = columns[size_t(j)];
      const double shared = is_alone ? 0.0 : to.products.col(column).dot(to.solved.col(other));
      own(i, j) = own(j, i) = scale[i] * scale[j] * (G(column, other) - shared);
    }
    own(i, i) += relative_ridge;
  }
  const Eigen::VectorXd scaled = own.ldlt().solve(right);
  Added result{to.squares - right.dot(scaled), scale.cwiseProduct(scaled), to.theta};
  if (is_alone) return result;
  for (Eigen::Index i = 0; i < n; ++i) result.before -= to.solved.col(columns[size_t(i)]) * result.theta[i];
  result.before = to.scale.cwiseProduct(result.before);
  return result;
}

}  // namespace loopwright::diagnosis
