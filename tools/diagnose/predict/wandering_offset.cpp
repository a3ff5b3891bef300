#include "tools/diagnose/predict/wandering_offset.h"
#include <cmath>

namespace loopwright::diagnosis {
namespace {

Eigen::VectorXd with_zero(const Eigen::VectorXd& of_axis) {
  Eigen::VectorXd longer = Eigen::VectorXd::Zero(of_axis.size() + 1);
  longer.head(of_axis.size()) = of_axis;
  return longer;
}

}  // namespace

LinearAxis with_offset(const LinearAxis& axis, const WanderingOffset& offset) {
  const Eigen::Index n = axis.A.rows(), ports = axis.C.rows();
  const double memory = std::exp(-1 / offset.memory_samples);
  LinearAxis longer = axis;
  longer.A = Eigen::MatrixXd::Zero(n + 1, n + 1);
  longer.A.topLeftCorner(n, n) = axis.A, longer.A(n, n) = memory;
  longer.C = Eigen::MatrixXd::Zero(ports, n + 1);
  longer.C.leftCols(n) = axis.C, longer.C(0, n) = 1;
  for (auto* push : {&longer.push, &longer.input_push, &longer.noise_push, &longer.slope_share})
    *push = with_zero(*push);
  longer.wander = Eigen::VectorXd::Zero(n + 1);
  longer.wander[n] = offset.size * std::sqrt(1 - memory * memory);
  return longer;
}

Gains without_correction_of_offset(const Gains& gains) {
  const Eigen::Index n = gains.K.rows() - 1;
  Gains longer = gains;
  longer.K = Eigen::MatrixXd::Zero(n + 2, gains.K.cols());
  longer.K.topRows(n) = gains.K.topRows(n), longer.K.row(n + 1) = gains.K.row(n);
  return longer;
}

}  // namespace loopwright::diagnosis
