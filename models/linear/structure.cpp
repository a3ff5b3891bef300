#include "models/linear/structure.h"

namespace loopwright {
namespace {

using Eigen::Index;

/// States that can be reached along A (from column to row) from the states in `marked`.
std::vector<bool> reached(const Eigen::MatrixXd& A, std::vector<bool> marked) {
  for (bool grows = true; grows;) {
    grows = false;
    for (Index j = 0; j < A.cols(); ++j)
      for (Index i = 0; i < A.rows(); ++i)
        if (marked[size_t(j)] && !marked[size_t(i)] && A(i, j) != 0) marked[size_t(i)] = grows = true;
  }
  return marked;
}

std::vector<bool> rows_with_entries(const Eigen::MatrixXd& B) {
  std::vector<bool> marked;
  for (Index i = 0; i < B.rows(); ++i) marked.push_back(!B.row(i).isZero(0));
  return marked;
}

}  // namespace

StateSpace connected_part(const StateSpace& system) {
  const std::vector<bool> driven = reached(system.A, rows_with_entries(system.B)),
                          seen = reached(system.A.transpose(), rows_with_entries(system.C.transpose()));
  std::vector<Index> kept;
  for (Index i = 0; i < system.states(); ++i)
    if (driven[size_t(i)] && seen[size_t(i)]) kept.push_back(i);
  StateSpace result = system;
  result.A = system.A(kept, kept);
  result.B = system.B(kept, Eigen::all);
  result.C = system.C(Eigen::all, kept);
  return result;
}

}  // namespace loopwright
