/// Normal equations of a few columns out of many, and of the same with others added (block elimination): a
/// search that adds hundreds of shapes to a set, one after the other, solves the set once.
#pragma once
#include <Eigen/Dense>
#include <vector>

namespace loopwright::diagnosis {

/// Products of all columns with each other, as far as they are used.
using Products = Eigen::MatrixXd;

/// The solution of some columns. They are scaled to one, with a ridge that only dependent columns notice.
struct Solved {
  std::vector<int> columns;
  double squares = 0;                ///< what they leave
  Eigen::VectorXd scale, theta;      ///< theta in units of the scale
  Eigen::MatrixXd products, solved;  ///< with every column of the products; the same, solved
};
/// `b`: products of every column with the errors, whose squares are `squares`.
Solved solve(const Products& G, std::vector<int> columns, const Eigen::VectorXd& b, double squares);

/// The solution with further columns.
struct Added {
  double squares = 0;             ///< what all leave
  Eigen::VectorXd theta, before;  ///< of the added columns; of those before
};
Added add(const Products& G, const std::vector<int>& columns, const Solved& to, const Eigen::VectorXd& b);

}  // namespace loopwright::diagnosis
