/// Matrices as in a file, lists of rows, and their operations for linear systems.
#pragma once
#include <span>
#include <vector>
#include "models/real/real.h"

namespace loopwright {

template <class Real> using MatrixRows = std::vector<std::vector<Real>>;

/// Number of columns; 0 for a matrix without rows.
template <class Real> int columns_of(const MatrixRows<Real>& m) { return m.empty() ? 0 : int(m[0].size()); }

template <class Real> bool has_shape(const MatrixRows<Real>& m, size_t rows, size_t columns) {
  if (m.size() != rows) return false;
  for (const auto& row : m)
    if (row.size() != columns) return false;
  return true;
}

/// Σ row_i x_i.
template <class Real> Real inner_product(const std::vector<Real>& row, std::span<const Real> x) {
  Real sum = 0.0;
  for (size_t i = 0; i < row.size(); ++i) sum = sum + row[i] * x[i];
  return sum;
}

}  // namespace loopwright
