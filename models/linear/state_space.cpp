#include "models/linear/state_space.h"
#include <stdexcept>
#include <unsupported/Eigen/MatrixFunctions>

namespace loopwright {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Padé's approximation of e^(-s τ) in controllable form:  Σ a_k (-p)^k / Σ b_k p^k,  p = s τ, with
/// a_k = (m+n-k)! m! / ((m+n)! k! (m-k)!), m = n-1, and b_k the same with n for m in the last factors.
StateSpace pade_delay(double delay, int order) {
  const int n = order, m = order - 1;
  std::vector<double> above(size_t(n) + 1, 0.0), below(size_t(n) + 1);
  above[0] = below[0] = 1;
  for (int k = 1; k <= n; ++k) {
    below[size_t(k)] = below[size_t(k) - 1] * double(n - k + 1) / (double(m + n - k + 1) * k);
    if (k <= m) above[size_t(k)] = -above[size_t(k) - 1] * double(m - k + 1) / (double(m + n - k + 1) * k);
  }
  StateSpace pade;
  pade.A = MatrixXd::Zero(n, n), pade.B = MatrixXd::Zero(n, 1), pade.C.resize(1, n),
  pade.D = MatrixXd::Zero(1, 1);
  for (int k = 0; k < n; ++k) {
    if (k + 1 < n) pade.A(k, k + 1) = 1 / delay;
    pade.A(n - 1, k) = -below[size_t(k)] / below[size_t(n)] / delay;
    pade.C(0, k) = above[size_t(k)] / below[size_t(n)];
  }
  pade.B(n - 1, 0) = 1 / delay;
  return pade;
}

}  // namespace

StateSpace with_approximate_delays(const StateSpace& system, int order) {
  if (system.delays.empty()) return system;
  const Index inputs = system.inputs(), outputs = system.outputs(), n = system.states(),
              delays = Index(system.delays.size()), extra = delays * order;
  MatrixXd A = MatrixXd::Zero(extra, extra), B = MatrixXd::Zero(extra, delays),
           C = MatrixXd::Zero(delays, extra);
  for (Index i = 0; i < delays; ++i) {
    const StateSpace pade = pade_delay(system.delays[size_t(i)], order);
    A.block(i * order, i * order, order, order) = pade.A, B.block(i * order, i, order, 1) = pade.B;
    C.block(i, i * order, 1, order) = pade.C;
  }
  // The delays have the input v = Cv x + Dvu u + Dvw w and the output w = C p, p' = A p + B v.
  const MatrixXd Cv = system.C.bottomRows(delays), Dvu = system.D.bottomLeftCorner(delays, inputs),
                 Dvw = system.D.bottomRightCorner(delays, delays);
  StateSpace result;
  result.A.resize(n + extra, n + extra);
  result.A << system.A, system.B.rightCols(delays) * C, B * Cv, A + B * Dvw * C;
  result.B.resize(n + extra, inputs);
  result.B << system.B.leftCols(inputs), B * Dvu;
  result.C.resize(outputs, n + extra);
  result.C << system.C.topRows(outputs), system.D.topRightCorner(outputs, delays) * C;
  result.D = system.D.topLeftCorner(outputs, inputs);
  return result;
}

StateSpace channel(const StateSpace& system, Index input, Index output) {
  if (!system.delays.empty()) throw std::invalid_argument("a channel of a system with delays");
  return {system.A,
          system.B.col(input),
          system.C.row(output),
          system.D.block(output, input, 1, 1),
          system.sample_time,
          {}};
}

StateSpace in_series(const StateSpace& first, const StateSpace& second) {
  const Index n = first.states(), m = second.states();
  StateSpace result;
  result.sample_time = first.sample_time;
  result.A.resize(n + m, n + m);
  result.A << first.A, MatrixXd::Zero(n, m), second.B * first.C, second.A;
  result.B.resize(n + m, first.B.cols());
  result.B << first.B, second.B * first.D;
  result.C.resize(second.C.rows(), n + m);
  result.C << second.D * first.C, second.C;
  result.D = second.D * first.D;
  return result;
}

StateSpace in_parallel(const StateSpace& first, const StateSpace& second, double sign) {
  const Index n = first.states(), m = second.states();
  StateSpace result;
  result.sample_time = first.sample_time;
  result.A.resize(n + m, n + m);
  result.A << first.A, MatrixXd::Zero(n, m), MatrixXd::Zero(m, n), second.A;
  result.B.resize(n + m, first.B.cols());
  result.B << first.B, second.B;
  result.C.resize(first.C.rows(), n + m);
  result.C << first.C, sign * second.C;
  result.D = first.D + sign * second.D;
  return result;
}

namespace {

/// Sets entries to zero where no path in A leads, as rounding may leave others: separate parts of a system
/// stay separate.
void keep_structure(const MatrixXd& A, MatrixXd& exponential) {
  const Index n = A.rows();
  Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> leads = A.array() != 0;
  for (Index k = 0; k < n; ++k)
    for (Index i = 0; i < n; ++i)
      if (leads(i, k)) leads.row(i) = leads.row(i) || leads.row(k);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j)
      if (i != j && !leads(i, j)) exponential(i, j) = 0;
}

}  // namespace

Propagation propagate(const MatrixXd& A, const MatrixXd& B, double duration) {
  const Index n = A.rows(), m = B.cols();
  MatrixXd both = MatrixXd::Zero(n + m, n + m);
  both.topLeftCorner(n, n) = A * duration, both.topRightCorner(n, m) = B * duration;
  MatrixXd power = both.exp();
  keep_structure(both, power);
  return {power.topLeftCorner(n, n), power.topRightCorner(n, m)};
}

StateSpace hold_discretization(const StateSpace& system, double sample_time) {
  if (!system.delays.empty()) throw std::invalid_argument("delays are replaced before a system is sampled");
  const Propagation step = propagate(system.A, system.B, sample_time);
  return {step.transition, step.input, system.C, system.D, sample_time, {}};
}

}  // namespace loopwright
