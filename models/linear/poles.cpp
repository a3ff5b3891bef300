#include "models/linear/poles.h"
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include "models/linear/decompositions.h"

namespace loopwright {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Complex = std::complex<double>;

/// Powers of two d such that the rows and columns of diag(d)⁻¹ A diag(d) have similar sums, including the
/// rows and columns `more` (B. N. Parlett, C. Reinsch, Numerische Mathematik 13, 1969).
std::vector<double> balancing_scales(MatrixXd A, MatrixXd more_columns, MatrixXd more_rows) {
  const Index n = A.rows();
  std::vector<double> scale(size_t(n), 1.0);
  A.diagonal().setZero();
  for (bool changed = true; changed;) {
    changed = false;
    for (Index i = 0; i < n; ++i) {
      const double column = A.col(i).lpNorm<1>() + more_rows.col(i).lpNorm<1>(),
                   row = A.row(i).lpNorm<1>() + more_columns.row(i).lpNorm<1>();
      if (column == 0 || row == 0) continue;
      const double factor = std::exp2(std::round(0.5 * std::log2(row / column)));
      if (!(column * factor + row / factor < 0.95 * (column + row))) continue;
      scale[size_t(i)] *= factor;
      A.col(i) *= factor, A.row(i) /= factor;
      more_rows.col(i) *= factor, more_columns.row(i) /= factor;
      changed = true;
    }
  }
  return scale;
}

Pole pole_at(Complex value, double sample_time) {
  Pole pole;
  pole.value = value;
  pole.continuous = sample_time > 0 ? std::log(value) / sample_time : value;
  pole.frequency = std::abs(pole.continuous);
  const bool forgets_at_once =
      std::abs(value) < 1e-6;  // a few rounding errors, or their root for chains of delays
  if (sample_time > 0 && forgets_at_once) pole.frequency = std::numeric_limits<double>::infinity();
  if (std::isfinite(pole.frequency) && pole.frequency > 0)
    pole.damping = -pole.continuous.real() / pole.frequency;
  return pole;
}

}  // namespace

StateSpace balanced(const StateSpace& system, std::vector<double>* scales) {
  const std::vector<double> scale = balancing_scales(system.A, system.B, system.C);
  const auto d = Eigen::Map<const Eigen::VectorXd>(scale.data(), Index(scale.size())).asDiagonal();
  const auto inverse = d.inverse();
  StateSpace result = system;
  result.A = inverse * system.A * d, result.B = inverse * system.B, result.C = system.C * d;
  if (scales) *scales = scale;
  return result;
}

std::vector<Pole> poles(const StateSpace& system) {
  const Index n = system.states();
  if (n == 0) return {};
  StateSpace alone{system.A, MatrixXd::Zero(n, 0), MatrixXd::Zero(0, n), {}, system.sample_time, {}};
  const auto [values, right] = eigensystem(balanced(alone).A);
  // The eigenvector matrix of a defective matrix, such as a chain of delays, has no inverse. The
  // pseudo-inverse is used then.
  const Eigen::MatrixXcd left = pseudo_inverse(right);
  std::vector<Pole> result;
  for (Index k = 0; k < n; ++k) {
    Pole pole = pole_at(values[k], system.sample_time);
    const Eigen::VectorXd share = (left.row(k).transpose().cwiseProduct(right.col(k))).cwiseAbs();
    const double sum = share.sum();
    for (Index i = 0; i < n; ++i) pole.participation.push_back(sum > 0 ? share[i] / sum : 0.0);
    result.push_back(std::move(pole));
  }
  std::ranges::stable_sort(result, [](const Pole& a, const Pole& b) {
    const double near = 1e-9 * std::max(a.frequency, b.frequency);
    if (a.frequency == b.frequency || std::abs(a.frequency - b.frequency) <= near)
      return a.value.imag() > b.value.imag();
    return a.frequency < b.frequency;
  });
  return result;
}

std::string_view name_of(Stability stability) {
  constexpr std::string_view names[] = {"stable", "boundary", "unstable"};
  return names[size_t(stability)];
}

Stability stability_of(const Pole& pole, double sample_time, double fastest) {
  constexpr double boundary = 1e-7;
  const double outside =
      sample_time > 0 ? std::abs(pole.value) - 1 : pole.value.real() / std::max(fastest, 1e-300);
  if (outside < -boundary) return Stability::stable;
  return outside <= boundary ? Stability::boundary : Stability::unstable;
}

double fastest_of(const std::vector<Pole>& poles) {
  double fastest = 0;
  for (const Pole& pole : poles) fastest = std::max(fastest, std::abs(pole.value));
  return fastest;
}

double outermost_pole(const StateSpace& system) {
  double largest = system.sample_time > 0 ? 0 : -std::numeric_limits<double>::infinity();
  for (const Pole& pole : poles(system))
    largest = std::max(largest, system.sample_time > 0 ? std::abs(pole.value) : pole.value.real());
  return largest;
}

bool is_stable(const StateSpace& system) {
  return outermost_pole(system) < (system.sample_time > 0 ? 1.0 : 0.0);
}

namespace {

/// Reduces the system until D has full row rank; the zeros do not change.
StateSpace with_full_row_rank(StateSpace s, double tolerance) {
  for (;;) {
    const Index n = s.states(), m = s.B.cols(), p = s.C.rows();
    if (p == 0 || n == 0) return s;
    const Eigen::JacobiSVD<MatrixXd> of_D(s.D, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Index rank = 0;
    for (Index i = 0; i < of_D.singularValues().size(); ++i) rank += of_D.singularValues()[i] > tolerance;
    if (m == 0) rank = 0;
    if (rank == p) return s;
    // Rotate the outputs: the last p - rank have no direct feedthrough.
    const MatrixXd U = m == 0 ? MatrixXd(MatrixXd::Identity(p, p)) : MatrixXd(of_D.matrixU());
    const MatrixXd C = U.transpose() * s.C, D = U.transpose() * s.D;
    const MatrixXd hidden = C.bottomRows(p - rank);
    const Eigen::JacobiSVD<MatrixXd> of_C(hidden, Eigen::ComputeFullV);
    Index seen = 0;
    for (Index i = 0; i < of_C.singularValues().size(); ++i) seen += of_C.singularValues()[i] > tolerance;
    if (seen == 0) {  // those outputs are always zero
      s.C = C.topRows(rank), s.D = D.topRows(rank);
      return s;
    }
    // Rotate the states: only the first `seen` affect these outputs. These states must be zero. Their
    // derivatives must be zero too and become the new outputs.
    MatrixXd V = of_C.matrixV();
    const MatrixXd A = V.transpose() * s.A * V, B = V.transpose() * s.B, rest = C.topRows(rank) * V;
    const Index kept = n - seen;
    StateSpace next;
    next.A = A.bottomRightCorner(kept, kept), next.B = B.bottomRows(kept);
    next.C.resize(seen + rank, kept), next.D.resize(seen + rank, m);
    next.C << A.topRightCorner(seen, kept), rest.rightCols(kept);
    next.D << B.topRows(seen), D.topRows(rank);
    s = next;
  }
}

StateSpace transposed(const StateSpace& s) {
  return {s.A.transpose(), s.C.transpose(), s.B.transpose(), s.D.transpose(), s.sample_time, {}};
}

}  // namespace

std::vector<Complex> transmission_zeros(const StateSpace& system, double tolerance) {
  StateSpace s = balanced({system.A,
                           system.B.leftCols(system.inputs()),
                           system.C.topRows(system.outputs()),
                           system.D.topLeftCorner(system.outputs(), system.inputs()),
                           system.sample_time,
                           {}});
  // Scale inputs and outputs to size one relative to the states: one tolerance then decides all ranks.
  const double size = std::max(s.A.norm(), 1e-300);
  for (Index j = 0; j < s.B.cols(); ++j) {
    const double by = s.B.col(j).norm() + s.D.col(j).norm();
    if (by > 0) s.B.col(j) *= size / by, s.D.col(j) *= size / by;
  }
  for (Index i = 0; i < s.C.rows(); ++i) {
    const double by = s.C.row(i).norm() + s.D.row(i).norm();
    if (by > 0) s.C.row(i) *= size / by, s.D.row(i) *= size / by;
  }
  StateSpace reduced = with_full_row_rank(s, tolerance * size);
  reduced = transposed(with_full_row_rank(transposed(reduced), tolerance * size));
  if (reduced.states() == 0) return {};
  if (reduced.B.cols() != reduced.C.rows()) return {};
  const MatrixXd blocked = reduced.D.rows() > 0
                               ? MatrixXd(reduced.A - reduced.B * reduced.D.fullPivLu().solve(reduced.C))
                               : reduced.A;
  const Eigen::VectorXcd values = eigenvalues(blocked);
  std::vector<Complex> zeros(values.begin(), values.end());
  std::ranges::sort(zeros, [](const Complex& a, const Complex& b) {
    return std::abs(a) != std::abs(b) ? std::abs(a) < std::abs(b) : a.imag() > b.imag();
  });
  return zeros;
}

}  // namespace loopwright
