/// The discrete algebraic Riccati equation, by structure-preserving doubling.
///
/// Plain loops in a fixed order: the result has the same bits in the program and in its SIMD modules.
#pragma once
#include <algorithm>
#include <cmath>
#include <utility>
#include "models/signal/matrix_rows.h"

namespace loopwright {

inline MatrixRows<double> zero_rows(size_t rows, size_t columns) {
  return MatrixRows<double>(rows, std::vector<double>(columns, 0.0));
}

inline MatrixRows<double> transposed_rows(const MatrixRows<double>& m) {
  MatrixRows<double> result = zero_rows(size_t(columns_of(m)), m.size());
  for (size_t i = 0; i < m.size(); ++i)
    for (size_t j = 0; j < m[i].size(); ++j) result[j][i] = m[i][j];
  return result;
}

inline MatrixRows<double> product_of_rows(const MatrixRows<double>& a, const MatrixRows<double>& b) {
  const size_t columns = size_t(columns_of(b));
  MatrixRows<double> result = zero_rows(a.size(), columns);
  for (size_t i = 0; i < a.size(); ++i)
    for (size_t k = 0; k < b.size(); ++k)
      for (size_t j = 0; j < columns; ++j) result[i][j] += a[i][k] * b[k][j];
  return result;
}

/// M X = Y by Gaussian elimination with row pivoting. Entries are not finite if M is singular.
inline MatrixRows<double> solved_rows(MatrixRows<double> M, MatrixRows<double> Y) {
  const size_t n = M.size(), columns = size_t(columns_of(Y));
  for (size_t k = 0; k < n; ++k) {
    size_t pivot = k;
    for (size_t i = k + 1; i < n; ++i)
      if (std::abs(M[i][k]) > std::abs(M[pivot][k])) pivot = i;
    std::swap(M[k], M[pivot]), std::swap(Y[k], Y[pivot]);
    for (size_t i = k + 1; i < n; ++i) {
      const double factor = M[i][k] / M[k][k];
      for (size_t j = k + 1; j < n; ++j) M[i][j] -= factor * M[k][j];
      for (size_t j = 0; j < columns; ++j) Y[i][j] -= factor * Y[k][j];
    }
  }
  for (size_t k = n; k-- > 0;)
    for (size_t j = 0; j < columns; ++j) {
      for (size_t i = k + 1; i < n; ++i) Y[k][j] -= M[k][i] * Y[i][j];
      Y[k][j] /= M[k][k];
    }
  return Y;
}

/// Powers of two t such that A, G and H in the coordinates x / t have rows and columns of similar size.
inline std::vector<double> riccati_scales(MatrixRows<double> A, MatrixRows<double> G, MatrixRows<double> H) {
  constexpr int most_rounds = 100;
  const size_t n = A.size();
  std::vector<double> scale(n, 1.0);
  bool changed = true;
  for (int round = 0; changed && round < most_rounds; ++round) {
    changed = false;
    for (size_t i = 0; i < n; ++i) {
      double row = 0, column = 0;
      for (size_t j = 0; j < n; ++j) {
        row += std::abs(G[i][j]) + (i == j ? 0 : std::abs(A[i][j]));
        column += std::abs(H[i][j]) + (i == j ? 0 : std::abs(A[j][i]));
      }
      if (row == 0 || column == 0) continue;
      const double factor = std::exp2(std::round(0.25 * std::log2(row / column)));
      if (factor == 1) continue;
      scale[i] *= factor, changed = true;
      for (size_t j = 0; j < n; ++j) {
        A[i][j] /= factor, G[i][j] /= factor, H[i][j] *= factor;
        A[j][i] *= factor, G[j][i] /= factor, H[j][i] *= factor;
      }
    }
  }
  return scale;
}

struct RiccatiRows {
  MatrixRows<double> X;
  bool has_converged = false;
};

/// The stabilizing solution of  X = Aᵀ X (I + G X)⁻¹ A + H  with symmetric, positive semidefinite G and H;
/// for a regulator G = B R⁻¹ Bᵀ and H = Q, for a filter the same of the transposed system. A may be singular.
/// After k rounds X is the cost of 2^k steps (E. K.-W. Chu, H.-Y. Fan, W.-W. Lin, C.-S. Wang, International
/// Journal of Control 77, 2004).
inline RiccatiRows riccati_by_doubling(MatrixRows<double> A, MatrixRows<double> G, MatrixRows<double> H) {
  constexpr int most_rounds = 60;  // 2^60 steps: what has not settled then does not settle
  const size_t n = A.size();
  const std::vector<double> t = riccati_scales(A, G, H);
  for (size_t i = 0; i < n; ++i)
    for (size_t j = 0; j < n; ++j) A[i][j] *= t[j] / t[i], G[i][j] /= t[i] * t[j], H[i][j] *= t[i] * t[j];
  RiccatiRows result;
  for (int round = 0; round < most_rounds && !result.has_converged; ++round) {
    MatrixRows<double> W = product_of_rows(G, H);
    for (size_t i = 0; i < n; ++i) W[i][i] += 1;
    const MatrixRows<double> WA = solved_rows(W, A), WG = solved_rows(W, G), At = transposed_rows(A),
                             more_H = product_of_rows(At, product_of_rows(H, WA)),
                             more_G = product_of_rows(A, product_of_rows(WG, At));
    double change = 0, size = 0;
    for (size_t i = 0; i < n; ++i)
      for (size_t j = 0; j < n; ++j) {
        const double added = 0.5 * (more_H[i][j] + more_H[j][i]);
        G[i][j] += 0.5 * (more_G[i][j] + more_G[j][i]), H[i][j] += added;
        change = std::max(change, std::abs(added)), size = std::max(size, std::abs(H[i][j]));
      }
    A = product_of_rows(A, WA);
    if (!std::isfinite(change) || !std::isfinite(size)) break;
    result.has_converged = change <= 1e-16 * size;
  }
  for (size_t i = 0; i < n; ++i)
    for (size_t j = 0; j < n; ++j) H[i][j] /= t[i] * t[j];
  result.X = std::move(H);
  return result;
}

}  // namespace loopwright
