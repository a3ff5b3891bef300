#include "tools/diagnose/predict/noise.h"
#include <cmath>
#include <limits>

namespace loopwright::diagnosis {
namespace {

/// P = A P Aᵀ - A P Cᵀ (C P Cᵀ + R)⁻¹ C P Aᵀ + Q by the structure-preserving doubling algorithm (Chu, Fan,
/// Lin 2005): converges quadratically, also with poles on the unit circle that are excited by noise.
Eigen::MatrixXd riccati(const Eigen::MatrixXd& A, const Eigen::MatrixXd& C, const Eigen::MatrixXd& Q,
                        const Eigen::MatrixXd& R) {
  const Eigen::Index n = A.rows();
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd F = A.transpose(), G = C.transpose() * R.inverse() * C, H = Q;
  for (int i = 0; i < 60; ++i) {
    const Eigen::PartialPivLU<Eigen::MatrixXd> W(identity + G * H);
    const Eigen::MatrixXd WF = W.solve(F), WG = W.solve(G);
    const Eigen::MatrixXd added = F.transpose() * H * WF;
    G += F * WG * F.transpose();
    F = F * WF;
    H += added;
    H = ((H + H.transpose()) / 2).eval(), G = ((G + G.transpose()) / 2).eval();
    if (added.cwiseAbs().maxCoeff() <= 1e-14 * H.cwiseAbs().maxCoeff()) break;
  }
  return H;
}

}  // namespace

double Noise::slow() const {
  return memory < 1 ? step / std::sqrt(1 - memory * memory) : std::numeric_limits<double>::infinity();
}

Gains gains_of(const LinearAxis& axis, const Noise& noise, double nominal_inertia) {
  const Eigen::Index n = axis.A.rows(), ports = axis.C.rows();
  const Eigen::VectorXd& push = axis.push;
  const double scale = axis.inertia / nominal_inertia;
  // In units in which all numbers are of order one.
  Eigen::VectorXd unit(n + 1), output(ports);
  for (Eigen::Index i = 0; i < n; ++i)
    unit[i] = std::max(std::max(std::abs(push[i]), std::abs(axis.noise_push[i])) * noise.white, 1e-300);
  const Eigen::Index own = n - axis.load_states;
  for (Eigen::Index i = own; i < n; ++i)  // nothing but the motion of the axis moves a load
    unit[i] = std::max(axis.A.row(i).head(own).cwiseAbs().dot(unit.head(own)), 1e-300);
  for (Eigen::Index p = 0; p < ports; ++p) output[p] = noise.measurement[size_t(p)];
  unit[n] = noise.white;
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n + 1, n + 1), C = Eigen::MatrixXd::Zero(ports, n + 1);
  A.topLeftCorner(n, n) = axis.A;
  A.topRightCorner(n, 1) = push;
  A(n, n) = noise.memory;
  C.leftCols(n) = axis.C;
  Eigen::VectorXd white = Eigen::VectorXd::Zero(n + 1), slow = white;
  white.head(n) = axis.noise_push * noise.white * scale;
  slow[n] = noise.step * scale;
  const Eigen::MatrixXd scaled_A = unit.cwiseInverse().asDiagonal() * A * unit.asDiagonal();
  const Eigen::MatrixXd scaled_C = output.cwiseInverse().asDiagonal() * C * unit.asDiagonal();
  const Eigen::VectorXd w = white.cwiseQuotient(unit), s = slow.cwiseQuotient(unit);
  const Eigen::MatrixXd Q = w * w.transpose() + s * s.transpose();
  const Eigen::MatrixXd R = Eigen::MatrixXd::Identity(ports, ports);
  const Eigen::MatrixXd P = riccati(scaled_A, scaled_C, Q, R);
  const Eigen::MatrixXd S = scaled_C * P * scaled_C.transpose() + R;
  Gains gains;
  gains.K = unit.asDiagonal() * P * scaled_C.transpose() * S.inverse() * output.cwiseInverse().asDiagonal();
  const Eigen::LLT<Eigen::MatrixXd> factor(output.asDiagonal() * S * output.asDiagonal());
  gains.whiten = factor.matrixL().solve(Eigen::MatrixXd::Identity(ports, ports));
  for (Eigen::Index p = 0; p < ports; ++p) gains.log_determinant -= 2 * std::log(gains.whiten(p, p));
  gains.memory = noise.memory;
  return gains;
}

}  // namespace loopwright::diagnosis
