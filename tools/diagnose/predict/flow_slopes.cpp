#include "tools/diagnose/predict/flow_slopes.h"
#include <utility>
#include "tools/diagnose/predict/sizes.h"

namespace loopwright::diagnosis {
namespace {

/// One column of X, with the input B u at the start, in the middle and at the end.
template <class Matrix, class Vector, class Column>
void advance(const Matrix& F, const Column& B, double length, const std::array<double, 3>& u, Vector x,
             Column to) {
  const Vector k1 = F * x + u[0] * B, k2 = F * (x + length / 2 * k1) + u[1] * B,
               k3 = F * (x + length / 2 * k2) + u[1] * B, k4 = F * (x + length * k3) + u[2] * B;
  to = x + length / 6 * (k1 + 2 * (k2 + k3) + k4);
}

}  // namespace

void FlowSlopes::change(std::span<const double> states, std::vector<int> sites, std::vector<double> at_sites,
                        bool with_ramps) {
  state_changes_.assign(states.begin(), states.end());
  sites_ = std::move(sites), site_changes_ = std::move(at_sites), has_ramps_ = with_ramps;
  const auto n = Eigen::Index(state_changes_.size()), count = Eigen::Index(sites_.size());
  F_.resize(n, n), A_.resize(n, n), B_.resize(n, count), held_.resize(n, count), ramp_.resize(n, count);
}

void FlowSlopes::begin() {
  A_.setIdentity(), held_.setZero(), ramp_.setZero();
  is_known_ = true;
}

void FlowSlopes::add_step(double length, double from, double to) {
  with_size(state_changes_.size(), [&]<int N>() { add_step_of<N>(length, from, to); });
}

template <int N> void FlowSlopes::add_step_of(double length, double from, double to) {
  using Vector = Eigen::Matrix<double, N, 1>;
  using Column = Eigen::Map<Vector>;
  const auto n = Eigen::Index(state_changes_.size());
  const Eigen::Map<const Eigen::Matrix<double, N, N>> F(F_.data(), n, n);
  const auto column = [&](Eigen::MatrixXd& of, Eigen::Index i) { return Column(of.data() + i * n, n); };
  bool is_finite = true;
  const auto through = [&](Eigen::MatrixXd& X, Eigen::Index i, Column B, const std::array<double, 3>& u) {
    advance<decltype(F), Vector, Column>(F, B, length, u, column(X, i), column(X, i));
    is_finite &= column(X, i).allFinite();
  };
  for (Eigen::Index i = 0; i < n; ++i) through(A_, i, column(F_, 0), {0, 0, 0});
  for (Eigen::Index s = 0; s < B_.cols(); ++s) {
    through(held_, s, column(B_, s), {1, 1, 1});
    if (has_ramps_) through(ramp_, s, column(B_, s), {2 * from - 1, from + to - 1, 2 * to - 1});
  }
  if (!is_finite) give_up();
}

}  // namespace loopwright::diagnosis
