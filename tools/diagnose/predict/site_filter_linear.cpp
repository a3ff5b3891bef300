/// What follows from a pass without the model: linear recursions along it, for a number of states that is
/// known to the compiler.
#include <cmath>
#include <limits>
#include "tools/diagnose/predict/site_filter.h"
#include "tools/diagnose/predict/sizes.h"

namespace loopwright::diagnosis {
namespace {

/// The logarithm of a product, taken once for many factors.
class LogarithmOfProduct {
 public:
  void multiply(double factor) {
    // A further factor keeps the product within what a double holds.
    constexpr double small = 1e-100, large = 1e100;
    product_ *= factor;
    if (product_ < small || product_ > large) sum_ += std::log(product_), product_ = 1;
  }
  double value() const { return sum_ + std::log(product_); }

 private:
  double product_ = 1, sum_ = 0;
};

/// P ← A P Aᵀ of a symmetric P, column by column.
template <class Matrix> void transform(const Matrix& A, Matrix& P, Matrix& product) {
  const Eigen::Index n = A.rows();
  for (Eigen::Index j = 0; j < n; ++j) {
    product.col(j) = P(0, j) * A.col(0);
    for (Eigen::Index k = 1; k < n; ++k) product.col(j) += P(k, j) * A.col(k);
  }
  for (Eigen::Index j = 0; j < n; ++j) {
    P.col(j) = A(j, 0) * product.col(0);
    for (Eigen::Index k = 1; k < n; ++k) P.col(j) += A(j, k) * product.col(k);
  }
}

/// Its upper half becomes its lower one.
template <class Matrix> void make_symmetric(Matrix& P) {
  for (Eigen::Index j = 1; j < P.rows(); ++j)
    for (Eigen::Index i = 0; i < j; ++i) P(i, j) = P(j, i);
}

/// Mean of a term over a sample, by Simpson's rule.
double mean_of(double start, double middle, double end) { return (start + 4 * middle + end) / 6; }

}  // namespace

double SiteFilter::objective_with(const SitePass& pass, const SiteNoise& noise) const {
  const auto n = Eigen::Index(pass.states);
  model_.work().add(pass.rows, Work::of_a_product * 2 * double(n * n * n));
  return with_size(pass.states, [&]<int N>() {
    using Vector = Eigen::Matrix<double, N, 1>;
    using Matrix = Eigen::Matrix<double, N, N>;
    using MapOf = Eigen::Map<const Vector>;
    Matrix P(n, n), A(n, n), product(n, n);
    Vector difference(n), delta(n), gain(n), change(n);  // from the states of the pass
    double squares = 0;
    LogarithmOfProduct variances;
    std::vector<double> kept(noise.slow.size());
    double step_of_kept = 0;
    for (size_t row = 0; row < pass.rows; ++row) {
      if (record_.begins_at(row)) {
        P.setZero(), difference.setZero();
        for (size_t i = 0; i < pass.states; ++i)
          P(Eigen::Index(i), Eigen::Index(i)) = initial_variance(noise, i);
      }
      delta.setZero();
      for (size_t j = 0; j < pass.outputs; ++j) {
        const size_t at = row * pass.outputs + j;
        if (std::isnan(pass.error[at])) continue;
        const MapOf C(&pass.C[at * pass.states], n);
        gain.noalias() = P * C;
        const double S = C.dot(gain) + squared(noise.measurement[j]);
        const double e = pass.innovation[at] - C.dot(difference) - C.dot(delta);
        for (Eigen::Index i = 0; i < n; ++i) P.col(i) -= (gain[i] / S) * gain;
        delta += (e / S) * gain;
        variances.multiply(S), squares += e * e / S;
      }
      A = Eigen::Map<const Matrix>(&pass.A[row * pass.states * pass.states], n, n);
      if (const double step = record_.step(row); step != step_of_kept) {
        for (size_t j = 0; j < kept.size(); ++j) kept[j] = noise.slow[j].kept(step);
        step_of_kept = step;
      }
      for (size_t j = 0; j < kept.size(); ++j)
        A(Eigen::Index(model_states_ + j), Eigen::Index(model_states_ + j)) = kept[j];
      if (pass.share[row] < 1) delta *= pass.share[row];
      change = difference + delta - MapOf(&pass.correction[row * pass.states], n);
      difference.noalias() = A * change;
      for (size_t j = 0; j < noise.slow.size(); ++j) {  // they decay differently than along the pass
        const size_t i = model_states_ + j;
        difference[Eigen::Index(i)] +=
            (A(Eigen::Index(i), Eigen::Index(i)) - pass.A[(row * pass.states + i) * pass.states + i]) *
            pass.filtered[row * pass.states + i];
      }
      transform<Matrix>(A, P, product);
      const double shorter = record_.sample_time / record_.step(row);
      for (size_t s = 0; s < noise.sites.size(); ++s) {
        const MapOf G(&pass.G[(row * pass.sites + size_t(noise.sites[s])) * pass.states], n);
        const double variance = shorter * squared(deviation_at(pass, row, noise, s));
        for (Eigen::Index i = 0; i < n; ++i) P.col(i) += (variance * G[i]) * G;
      }
      for (size_t j = 0; j < noise.slow.size(); ++j) {
        const auto i = Eigen::Index(model_states_ + j);
        P(i, i) += squared(noise.slow[j].size) * (1 - A(i, i) * A(i, i));
      }
      make_symmetric(P);
    }
    const double objective = variances.value() + squares;
    return std::isfinite(objective) ? objective : std::numeric_limits<double>::infinity();
  });
}

void SiteFilter::respond(const SitePass& pass, int site, std::span<const double> start,
                         std::span<const double> middle, std::span<const double> end,
                         std::span<double> column) const {
  const auto n = Eigen::Index(pass.states);
  model_.work().add(pass.rows, Work::of_a_response + Work::of_a_product * double(n * n));
  const int sensor = model_.output_of_sensor(site);
  with_size(pass.states, [&]<int N>() {
    using Vector = Eigen::Matrix<double, N, 1>;
    using MapOf = Eigen::Map<const Vector>;
    Vector difference(n), next(n), before(n);
    for (size_t row = 0; row < pass.rows; ++row) {
      if (record_.begins_at(row)) difference.setZero();
      before = difference;
      for (size_t j = 0; j < pass.outputs; ++j) {
        const size_t at = row * pass.outputs + j;
        if (std::isnan(pass.error[at])) {
          column[at] = 0;
          continue;
        }
        const double measured = int(j) == sensor ? start[row] : 0;
        const double e = MapOf(&pass.C[at * pass.states], n).dot(difference) + measured;
        column[at] = e / std::sqrt(pass.variance[at]);
        difference -= e * MapOf(&pass.gain[at * pass.states], n);
      }
      if (const double share = pass.share[row]; share < 1)
        difference = (share * difference + (1 - share) * before).eval();
      const size_t g = (row * pass.sites + size_t(site)) * pass.states;
      const Eigen::Map<const Eigen::Matrix<double, N, N>> A(&pass.A[row * pass.states * pass.states], n, n);
      next.noalias() = A * difference;
      next += mean_of(start[row], middle[row], end[row]) * MapOf(&pass.G[g], n);
      next += (end[row] - start[row]) / 2 * MapOf(&pass.ramp[g], n);
      difference = next;
    }
  });
}

}  // namespace loopwright::diagnosis
