#include "models/gp/dense.h"
#include <Eigen/Cholesky>
#include <limits>
#include <numbers>
#include <stdexcept>
#include "models/real/functions.h"

namespace loopwright::gp {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd covariance_matrix(const Kernel& kernel, const std::vector<Point>& x) {
  const auto n = Eigen::Index(x.size());
  MatrixXd k(n, n);
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = j; i < n; ++i)
      k(i, j) = k(j, i) = covariance(kernel, x[size_t(i)], x[size_t(j)]) + (i == j) * square(kernel.noise);
  return k;
}

}  // namespace

Evidence dense_evidence(const Kernel& kernel, const Samples& samples) {
  const auto& x = samples.inputs;
  const auto n = Eigen::Index(x.size());
  const Eigen::LLT<MatrixXd> root(covariance_matrix(kernel, x));
  Evidence evidence{-std::numeric_limits<double>::infinity(),
                    std::vector<double>(parameters_of(kernel).size(), 0.0)};
  if (root.info() != Eigen::Success) return evidence;
  const Eigen::Map<const VectorXd> y(samples.labels.data(), n);
  const VectorXd weights = root.solve(y);
  double log_determinant = 0;
  for (Eigen::Index i = 0; i < n; ++i) log_determinant += 2 * natural_logarithm(root.matrixLLT()(i, i));
  evidence.value = -0.5 * y.dot(weights) - 0.5 * log_determinant -
                   0.5 * double(n) * natural_logarithm(2 * std::numbers::pi);

  // ∂/∂θ = ½ tr((w wᵀ - K⁻¹) ∂K/∂θ); pairs i ≠ j count twice.
  const MatrixXd inverse = root.solve(MatrixXd::Identity(n, n));
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = j; i < n; ++i) {
      const double share = (weights(i) * weights(j) - inverse(i, j)) * (i == j ? 0.5 : 1.0);
      const Point &a = x[size_t(i)], &b = x[size_t(j)];
      size_t p = 0;
      for (const Term& term : kernel.terms) {
        const std::array<double, 2> r{a[0] - b[0], a[1] - b[1]};
        evidence.gradient[p++] += share * 2 * covariance(term, a, b);
        for (size_t d = 0; d < 2; ++d)
          if (term.along[d].kind != Shape::Kind::constant)
            evidence.gradient[p++] += share * square(term.deviation) * length_slope(term.along[d], r[d]) *
                                      correlation(term.along[1 - d], r[1 - d]);
      }
      if (i == j) evidence.gradient[p] += share * 2 * square(kernel.noise);
    }
  return evidence;
}

DensePosterior::DensePosterior(Kernel kernel, const Samples& samples)
    : kernel_(std::move(kernel)), inputs_(samples.inputs), weights_(samples.labels) {
  const auto n = Eigen::Index(inputs_.size());
  const Eigen::LLT<MatrixXd> root(covariance_matrix(kernel_, inputs_));
  if (root.info() != Eigen::Success)
    throw std::domain_error("the covariance matrix is not positive definite: the noise is too small");
  Eigen::Map<VectorXd> weights(weights_.data(), n);
  root.solveInPlace(weights);
  root_.assign(root.matrixLLT().data(), root.matrixLLT().data() + n * n);
}

double DensePosterior::mean(const Point& at) const {
  double sum = 0;
  for (size_t i = 0; i < inputs_.size(); ++i) sum += weights_[i] * covariance(kernel_, at, inputs_[i]);
  return sum;
}

Jet DensePosterior::term(size_t index, const Point& at) const {
  const Term& term = kernel_.terms[index];
  Jet sum{};
  for (size_t i = 0; i < inputs_.size(); ++i) {
    const double r0 = at[0] - inputs_[i][0], r1 = at[1] - inputs_[i][1];
    const double w = weights_[i] * square(term.deviation);
    const double c0 = correlation(term.along[0], r0), s0 = distance_slope(term.along[0], r0);
    const double c1 = correlation(term.along[1], r1), s1 = distance_slope(term.along[1], r1);
    sum[0] += w * c0 * c1, sum[1] += w * s0 * c1, sum[2] += w * c0 * s1, sum[3] += w * s0 * s1;
  }
  return sum;
}

double DensePosterior::term_norm(size_t index) const {
  const Term& term = kernel_.terms[index];
  double square_norm = 0;
  for (size_t i = 0; i < inputs_.size(); ++i)
    for (size_t j = 0; j < inputs_.size(); ++j)
      square_norm += weights_[i] * weights_[j] * covariance(term, inputs_[i], inputs_[j]);
  return term.deviation * std::sqrt(std::max(0.0, square_norm));
}

double DensePosterior::weight_sum() const {
  double sum = 0;
  for (double w : weights_) sum += std::abs(w);
  return sum;
}

double DensePosterior::variance(const Point& at) const {
  const auto n = Eigen::Index(inputs_.size());
  VectorXd k(n);
  for (Eigen::Index i = 0; i < n; ++i) k(i) = covariance(kernel_, at, inputs_[size_t(i)]);
  const Eigen::Map<const MatrixXd> root(root_.data(), n, n);
  root.triangularView<Eigen::Lower>().solveInPlace(k);
  return std::max(0.0, prior_variance(kernel_) - k.squaredNorm());
}

}  // namespace loopwright::gp
