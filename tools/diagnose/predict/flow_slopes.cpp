#include "tools/diagnose/predict/flow_slopes.h"
#include <cmath>
#include <utility>
#include "tools/diagnose/predict/sizes.h"

namespace loopwright::diagnosis {
namespace {

/// Where a step changes more than that, as at the steep part of a friction, what is linear in its middle
/// grows beyond what the step itself leaves: the method is stable to 2.8.
constexpr double most_of_a_step = 2.5;

template <class Matrix> Matrix product(const Matrix& a, const Matrix& b) {
  Matrix c = Matrix::Zero(a.rows(), b.cols());
  for (Eigen::Index j = 0; j < b.cols(); ++j)
    for (Eigen::Index k = 0; k < a.cols(); ++k) c.col(j) += b(k, j) * a.col(k);
  return c;
}

}  // namespace

void FlowSlopes::prepare(std::span<const double> states, std::vector<int> sites, std::vector<double> at_sites,
                         bool with_ramps) {
  state_changes_.assign(states.begin(), states.end());
  sites_ = std::move(sites), site_changes_ = std::move(at_sites), has_ramps_ = with_ramps;
  const auto n = Eigen::Index(state_changes_.size()), count = Eigen::Index(sites_.size());
  F_.resize(n, n), A_.resize(n, n), B_.resize(n, count), held_.resize(n, count), ramp_.resize(n, count);
}

void FlowSlopes::begin() {
  A_.setIdentity(), held_.setZero(), ramp_.setZero();
  is_known_ = is_first_ = true;
}

double FlowSlopes::size_of_step(double length) const {
  double largest = 0;
  for (Eigen::Index i = 0; i < F_.rows(); ++i) {
    double row = 0;
    for (Eigen::Index j = 0; j < F_.cols(); ++j)
      row += std::abs(F_(i, j)) * state_changes_[size_t(j)] / state_changes_[size_t(i)];
    if (!(length * row < largest)) largest = length * row;
  }
  return largest;
}

void FlowSlopes::add_step(double length, double from, double to) {
  with_size(state_changes_.size(), [&]<int N>() { add_step_of<N>(length, from, to); });
}

/// With M = length F a step is X ← Φ X + length (Ψ₀ B u(0) + Ψ₁ B u(h/2) + B u(h) / 6), where
///   Φ = I + M Ψ,                       Ψ = I + M/2 + M²/6 + M³/24,
///   Ψ₀ = (I + M + M²/2 + M³/4) / 6,    Ψ₁ = (4 I + 2 M + M²/2) / 6.
template <int N> void FlowSlopes::add_step_of(double length, double from, double to) {
  using Matrix = Eigen::Matrix<double, N, N>;
  using Vector = Eigen::Matrix<double, N, 1>;
  const auto n = Eigen::Index(state_changes_.size());
  if (!(size_of_step(length) < most_of_a_step)) return give_up();
  const Matrix one = Matrix::Identity(n, n), M = length * Eigen::Map<const Matrix>(F_.data(), n, n),
               square = product<Matrix>(M, M), cube = product<Matrix>(square, M);
  const Matrix whole = one + M / 2 + square / 6 + cube / 24, through = one + product<Matrix>(M, whole);
  Eigen::Map<Matrix> A(A_.data(), n, n);
  A = is_first_ ? through : product<Matrix>(through, A);
  is_first_ = false;
  bool is_finite = A.allFinite();
  const auto column = [&](Eigen::MatrixXd& of, Eigen::Index i) {
    return Eigen::Map<Vector>(of.data() + i * n, n);
  };
  for (Eigen::Index s = 0; s < B_.cols(); ++s) {
    const Vector B = length * column(B_, s);
    column(held_, s) = (through * column(held_, s) + whole * B).eval();
    is_finite &= column(held_, s).allFinite();
    if (!has_ramps_) continue;
    const Vector MB = M * B, MMB = square * B, MMMB = cube * B;
    const double first = 2 * from - 1, middle = from + to - 1, last = 2 * to - 1;
    const Vector added =
        first * (B + MB + MMB / 2 + MMMB / 4) + middle * (4 * B + 2 * MB + MMB / 2) + last * B;
    column(ramp_, s) = (through * column(ramp_, s) + added / 6).eval();
    is_finite &= column(ramp_, s).allFinite();
  }
  if (!is_finite) give_up();
}

}  // namespace loopwright::diagnosis
