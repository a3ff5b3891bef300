#include "models/linear/riccati.h"
#include <Eigen/Cholesky>
#include <Eigen/Jacobi>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include "models/linear/decompositions.h"
#include "models/signal/riccati_doubling.h"

namespace loopwright {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Complex = std::complex<double>;

/// The same problem without cross terms: u = v - R⁻¹ Nᵀ x.
struct PlainProblem {
  MatrixXd A, G, Q, undo;  ///< G = B R⁻¹ Bᵀ; undo: R⁻¹ Nᵀ

  PlainProblem(const StateSpace& s, const QuadraticCost& cost) {
    const Eigen::LLT<MatrixXd> R(cost.R);
    undo = R.solve(cost.N.transpose());
    A = s.A - s.B * undo, Q = cost.Q - cost.N * undo, G = s.B * R.solve(s.B.transpose());
    Q = (0.5 * (Q + Q.transpose())).eval(), G = (0.5 * (G + G.transpose())).eval();
  }
};

MatrixRows<double> rows_of(const MatrixXd& m) {
  MatrixRows<double> rows;
  for (Index i = 0; i < m.rows(); ++i) rows.emplace_back(m.row(i).begin(), m.row(i).end());
  return rows;
}

MatrixXd matrix_of(const MatrixRows<double>& rows) {
  MatrixXd m(Index(rows.size()), Index(columns_of(rows)));
  for (Index i = 0; i < m.rows(); ++i)
    for (Index j = 0; j < m.cols(); ++j) m(i, j) = rows[size_t(i)][size_t(j)];
  return m;
}

/// Moves the eigenvalues in the left half plane to the front of a Schur form A = U T U*.
Index put_stable_first(Triangularised& schur) {
  Index stable = 0;
  for (Index k = 0; k < schur.T.rows(); ++k) {
    if (!(schur.T(k, k).real() < 0)) continue;
    for (Index i = k - 1; i >= stable; --i) {  // neighbours change places
      Eigen::JacobiRotation<Complex> rotation;
      rotation.makeGivens(schur.T(i, i + 1), schur.T(i + 1, i + 1) - schur.T(i, i));
      schur.T.applyOnTheLeft(i, i + 1, rotation.adjoint());
      schur.T.applyOnTheRight(i, i + 1, rotation);
      schur.U.applyOnTheRight(i, i + 1, rotation);
    }
    ++stable;
  }
  return stable;
}

/// Aᵀ X + X A - X G X + Q = 0; empty without a solution.
MatrixXd continuous_solution(const PlainProblem& problem) {
  const Index n = problem.A.rows();
  const std::vector<double> scales =
      riccati_scales(rows_of(problem.A), rows_of(problem.G), rows_of(problem.Q));
  const Eigen::VectorXd t = Eigen::Map<const Eigen::VectorXd>(scales.data(), n);
  const MatrixXd A = t.cwiseInverse().asDiagonal() * problem.A * t.asDiagonal();
  MatrixXd hamiltonian(2 * n, 2 * n);
  hamiltonian << A, -(t.cwiseInverse().asDiagonal() * problem.G * t.cwiseInverse().asDiagonal()),
      -(t.asDiagonal() * problem.Q * t.asDiagonal()), -A.transpose();
  Triangularised schur = triangularised(hamiltonian);
  if (put_stable_first(schur) != n) return {};
  const MatrixXcd top = schur.U.topLeftCorner(n, n), bottom = schur.U.bottomLeftCorner(n, n);
  const MatrixXd X = top.transpose().fullPivLu().solve(bottom.transpose()).transpose().real();
  return t.cwiseInverse().asDiagonal() * (0.5 * (X + X.transpose())) * t.cwiseInverse().asDiagonal();
}

MatrixXd sampled_solution(const PlainProblem& problem) {
  const RiccatiRows found = riccati_by_doubling(rows_of(problem.A), rows_of(problem.G), rows_of(problem.Q));
  return found.has_converged ? matrix_of(found.X) : MatrixXd();
}

/// The sum of the terms relative to the largest of them, in coordinates in which all states count alike.
double relative_sum(const std::vector<MatrixXd>& terms) {
  const Index n = terms[0].rows();
  Eigen::VectorXd size = Eigen::VectorXd::Zero(n);
  MatrixXd sum = MatrixXd::Zero(n, n);
  for (const MatrixXd& term : terms) size = size.cwiseMax(term.diagonal().cwiseAbs()), sum += term;
  for (double& s : size) s = s > 0 ? 1 / std::sqrt(s) : 1;
  double largest = 0;
  for (const MatrixXd& term : terms)
    largest = std::max(largest, (size.asDiagonal() * term * size.asDiagonal()).norm());
  return largest > 0 ? (size.asDiagonal() * sum * size.asDiagonal()).norm() / largest : 0;
}

constexpr double largest_residual = 1e-6;

/// The directions w in which w* M is small.
struct RankGap {
  double size = 0;            ///< smallest over largest singular value
  std::vector<double> share;  ///< of each row of M in these directions; sum 1
};
RankGap rank_gap(const MatrixXcd& M, double tolerance) {
  const LeftSingular svd = left_singular(M);
  const Index n = M.rows();
  const double largest = std::max(svd.values[0], 1e-300);
  RankGap gap{svd.values[n - 1] / largest, std::vector<double>(size_t(n), 0.0)};
  double sum = 0;
  for (Index k = 0; k < n; ++k)
    if (k == n - 1 || svd.values[k] < tolerance * largest)
      for (Index i = 0; i < n; ++i)
        gap.share[size_t(i)] += std::norm(svd.U(i, k)), sum += std::norm(svd.U(i, k));
  for (double& share : gap.share) share /= sum;
  return gap;
}

}  // namespace

StateSpace dual(const StateSpace& system) {
  const Index n = system.states(), m = system.outputs();
  return {system.A.transpose(), system.C.topRows(m).transpose(),
          MatrixXd::Zero(0, n), MatrixXd::Zero(0, m),
          system.sample_time,   {}};
}

std::vector<Obstacle> obstacles(const StateSpace& system, const QuadraticCost& cost) {
  constexpr double boundary = 1e-7;  // a double eigenvalue is known to the root of the rounding error
  const Index n = system.states(), m = system.B.cols();
  const PlainProblem plain(system, cost);
  const StateSpace s = balanced({system.A, system.B, plain.Q, MatrixXd::Zero(n, m), system.sample_time, {}});
  const StateSpace seen = balanced({plain.A, MatrixXd::Zero(n, 0), plain.Q, {}, system.sample_time, {}});
  const auto distance = [&](const Pole& pole) {  // from the boundary, positive outside
    return system.sample_time > 0 ? std::abs(pole.value) - 1
                                  : pole.value.real() / std::max(1.0, std::abs(pole.value));
  };
  std::vector<Obstacle> found;
  Obstacle worst{Obstacle::Kind::ill_conditioned, {}};
  double smallest = 1;
  const auto test = [&](Pole pole, const MatrixXcd& M, Obstacle::Kind kind) {
    const RankGap gap = rank_gap(M, boundary);
    pole.participation = gap.share;
    if (gap.size < smallest) smallest = gap.size, worst.mode = pole;
    const bool is_known = std::ranges::any_of(found, [&](const Obstacle& other) {
      return std::abs(other.mode.value - pole.value) < 1e-6 * std::max(1.0, std::abs(pole.value));
    });
    if (gap.size < boundary && !is_known) found.push_back({kind, pole});
  };
  for (const Pole& pole : poles(system)) {
    if (pole.value.imag() < 0 || distance(pole) < -boundary) continue;
    MatrixXcd M(n, n + m);
    M << s.A.cast<Complex>() - pole.value * MatrixXcd::Identity(n, n), s.B.cast<Complex>();
    test(pole, M, Obstacle::Kind::uncontrollable);
  }
  if (!found.empty()) return found;
  for (const Pole& pole : poles({plain.A, system.B, {}, {}, system.sample_time, {}})) {
    if (pole.value.imag() < 0 || std::abs(distance(pole)) > boundary) continue;
    MatrixXcd M(n, 2 * n);
    M << (seen.A.cast<Complex>() - pole.value * MatrixXcd::Identity(n, n)).transpose(),
        seen.C.cast<Complex>().transpose();
    test(pole, M, Obstacle::Kind::free);
  }
  if (found.empty() && regulator(system, cost).poles.empty()) found.push_back(worst);
  return found;
}

Regulator regulator(const StateSpace& system, const QuadraticCost& cost) {
  const PlainProblem plain(system, cost);
  const bool is_sampled = system.sample_time > 0;
  Regulator result;
  result.X = is_sampled ? sampled_solution(plain) : continuous_solution(plain);
  if (result.X.size() == 0 || !result.X.allFinite()) return result;
  const MatrixXd &A = system.A, &B = system.B, &X = result.X;
  if (is_sampled) {
    const MatrixXd cross = B.transpose() * X * A + cost.N.transpose();
    result.K = (cost.R + B.transpose() * X * B).llt().solve(cross);
    result.residual = relative_sum({A.transpose() * X * A, -X, -cross.transpose() * result.K, cost.Q});
  } else {
    const MatrixXd cross = B.transpose() * X + cost.N.transpose();
    result.K = cost.R.llt().solve(cross);
    result.residual = relative_sum({A.transpose() * X, X * A, -cross.transpose() * result.K, cost.Q});
  }
  const StateSpace closed{A - B * result.K, B, {}, {}, system.sample_time, {}};
  if (!result.K.allFinite() || !(result.residual < largest_residual)) return result;
  result.poles = poles(closed);
  const bool all_stable =
      std::ranges::all_of(result.poles, [&](const Pole& p) { return p.is_stable(system.sample_time); });
  if (!all_stable) result.poles.clear();
  return result;
}

Filter filter(const StateSpace& system, const QuadraticCost& noise) {
  const Regulator found = regulator(dual(system), noise);
  Filter result;
  result.P = found.X, result.poles = found.poles, result.residual = found.residual;
  if (found.poles.empty()) return result;
  result.gain = found.K.transpose();
  if (system.sample_time == 0) return result;
  const MatrixXd C = system.C.topRows(system.outputs());
  result.predictor = result.gain;
  result.gain = (C * found.X * C.transpose() + noise.R).llt().solve(C * found.X).transpose();
  return result;
}

}  // namespace loopwright
