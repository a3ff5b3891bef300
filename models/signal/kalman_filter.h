/// The covariances and gains of a Kalman filter, on any scalar of a simulation.
#pragma once
#include "models/real/functions.h"
#include "models/signal/riccati_doubling.h"

namespace loopwright {

/// Matrices in one row after another.
template <class Real> struct RowMajor {
  std::span<Real> numbers;
  int columns;
  Real& operator()(int i, int j) const { return numbers[size_t(i * columns + j)]; }
};

/// S := L, S = L Lᵀ, in its lower triangle. False for lanes in which S is not positive definite.
template <class Real> MaskOf<Real> cholesky(const RowMajor<Real>& S, int n) {
  MaskOf<Real> is_positive = true;
  for (int j = 0; j < n; ++j) {
    Real pivot = S(j, j);
    for (int k = 0; k < j; ++k) pivot = pivot - S(j, k) * S(j, k);
    is_positive = is_positive & (pivot > 0.0);
    const Real root = square_root(maximum(pivot, Real(0.0)));
    S(j, j) = root;
    for (int i = j + 1; i < n; ++i) {
      Real sum = S(i, j);
      for (int k = 0; k < j; ++k) sum = sum - S(i, k) * S(j, k);
      S(i, j) = sum / root;
    }
  }
  return is_positive;
}

/// M = P Cᵀ (C P Cᵀ + R)⁻¹, n states by p measurements; S: room for p by p. False for lanes in which the
/// covariance of the innovation is not positive definite.
template <class Real>
MaskOf<Real> kalman_gain(const RowMajor<Real>& P, const MatrixRows<Real>& C, const MatrixRows<Real>& R,
                         const RowMajor<Real>& S, const RowMajor<Real>& M) {
  const int n = P.columns, p = int(C.size());
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < p; ++j) {
      Real sum = 0.0;
      for (int k = 0; k < n; ++k) sum = sum + P(i, k) * C[size_t(j)][size_t(k)];
      M(i, j) = sum;
    }
  for (int i = 0; i < p; ++i)
    for (int j = 0; j < p; ++j) {
      Real sum = R[size_t(i)][size_t(j)];
      for (int k = 0; k < n; ++k) sum = sum + C[size_t(i)][size_t(k)] * M(k, j);
      S(i, j) = sum;
    }
  const MaskOf<Real> is_positive = cholesky(S, p);
  for (int i = 0; i < n; ++i) {  // each row m of M: m L Lᵀ = (P Cᵀ)_i
    for (int j = 0; j < p; ++j) {
      Real sum = M(i, j);
      for (int k = 0; k < j; ++k) sum = sum - S(j, k) * M(i, k);
      M(i, j) = sum / S(j, j);
    }
    for (int j = p - 1; j >= 0; --j) {
      Real sum = M(i, j);
      for (int k = j + 1; k < p; ++k) sum = sum - S(k, j) * M(i, k);
      M(i, j) = sum / S(j, j);
    }
  }
  return is_positive;
}

/// P := A [(I - M C) P (I - M C)ᵀ + M R Mᵀ] Aᵀ + Q, a form that stays symmetric and positive; W, V: room for
/// n by n, V also for n by p.
template <class Real>
void next_covariance(const MatrixRows<Real>& A, const MatrixRows<Real>& C, const MatrixRows<Real>& Q,
                     const MatrixRows<Real>& R, const RowMajor<Real>& M, const RowMajor<Real>& P,
                     const RowMajor<Real>& W, const RowMajor<Real>& V) {
  const int n = P.columns, p = int(C.size());
  // W = A (I - M C), then V = W P.
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      Real sum = i == j ? 1.0 : 0.0;
      for (int k = 0; k < p; ++k) sum = sum - M(i, k) * C[size_t(k)][size_t(j)];
      V(i, j) = sum;
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      Real sum = 0.0;
      for (int k = 0; k < n; ++k) sum = sum + A[size_t(i)][size_t(k)] * V(k, j);
      W(i, j) = sum;
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      Real sum = 0.0;
      for (int k = 0; k < n; ++k) sum = sum + W(i, k) * P(k, j);
      V(i, j) = sum;
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) {
      Real sum = Q[size_t(i)][size_t(j)];
      for (int k = 0; k < n; ++k) sum = sum + V(i, k) * W(j, k);
      P(i, j) = sum;
    }
  const RowMajor<Real> AM{V.numbers, p};
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < p; ++j) {
      Real sum = 0.0;
      for (int k = 0; k < n; ++k) sum = sum + A[size_t(i)][size_t(k)] * M(k, j);
      AM(i, j) = sum;
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) {
      Real sum = P(i, j);
      for (int k = 0; k < p; ++k)
        for (int l = 0; l < p; ++l) sum = sum + AM(i, k) * R[size_t(k)][size_t(l)] * AM(j, l);
      P(i, j) = sum, P(j, i) = sum;
    }
}

/// The covariance P of the steady filter before its correction, from numbers of one run.
inline RiccatiRows steady_covariance(const MatrixRows<double>& A, const MatrixRows<double>& C,
                                     const MatrixRows<double>& Q, const MatrixRows<double>& R) {
  const MatrixRows<double> Ct = transposed_rows(C);
  return riccati_by_doubling(transposed_rows(A), product_of_rows(Ct, solved_rows(R, C)), Q);
}

}  // namespace loopwright
