#include "models/linear/norms.h"
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include "models/linear/decompositions.h"
#include "models/linear/frequency_range.h"
#include "models/linear/frequency_response.h"
#include "models/linear/poles.h"

namespace loopwright {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

double row_sum_norm(const MatrixXd& A) { return A.rows() ? A.cwiseAbs().rowwise().sum().maxCoeff() : 0.0; }

/// |C v| + |C A v| + … ≤ factor · max |v|.
double tail_factor(const StateSpace& s) {
  MatrixXd power = s.A;
  Index steps = 1;
  for (; row_sum_norm(power) > 0.5; power = power * power, steps *= 2)
    if (steps > Index(1) << 40)
      throw std::domain_error("the system forgets too slowly for its gain to be summed");
  // S = Σ |C A^j| over j < steps, by doubling: |C A^j| for j in [m, 2m) is at most S_m |A^m|.
  RowVectorXd sum = s.C.row(0).cwiseAbs();
  MatrixXd doubled = s.A;
  for (Index done = 1; done < steps; done *= 2, doubled = doubled * doubled) sum += sum * doubled.cwiseAbs();
  return sum.sum() / (1 - row_sum_norm(power));
}

/// The continuous system with the same responses, at s = (z - 1)/(z + 1).
StateSpace bilinear(const StateSpace& s) {
  if (s.sample_time == 0) return s;
  const Index n = s.states();
  const MatrixXd inverse = (s.A + MatrixXd::Identity(n, n)).inverse();
  const double root = std::sqrt(2.0);
  return {inverse * (s.A - MatrixXd::Identity(n, n)),
          root * inverse * s.B,
          root * s.C * inverse,
          s.D - s.C * inverse * s.B,
          0,
          {}};
}

/// Frequencies at which a singular value equals `level`: the imaginary eigenvalues of the Hamiltonian.
std::vector<double> frequencies_at(const StateSpace& s, double level) {
  const Index n = s.states(), m = s.B.cols(), p = s.C.rows();
  const MatrixXd R = (level * level * MatrixXd::Identity(m, m) - s.D.transpose() * s.D).inverse();
  const MatrixXd A = s.A + s.B * R * s.D.transpose() * s.C;
  MatrixXd H(2 * n, 2 * n);
  H << A, s.B * R * s.B.transpose(),
      -s.C.transpose() * (MatrixXd::Identity(p, p) + s.D * R * s.D.transpose()) * s.C, -A.transpose();
  const Eigen::VectorXcd values = eigenvalues(H);
  const double size = std::max(values.cwiseAbs().maxCoeff(), 1e-300);
  std::vector<double> found;
  for (const std::complex<double>& value : values)
    if (std::abs(value.real()) <= 1e-9 * std::max(std::abs(value), 1e-3 * size) && value.imag() >= 0)
      found.push_back(value.imag());
  std::ranges::sort(found);
  return found;
}

/// Sums that would take more samples are abandoned. The decay of the response is checked once per
/// `look_ahead` samples to detect this early.
constexpr long most_samples = 20'000'000, look_ahead = 64 * 4096;

}  // namespace

Bounds peak_to_peak_gain(const StateSpace& system, double tolerance) {
  if (system.sample_time <= 0)
    throw std::invalid_argument("a continuous system is sampled before its gain is summed");
  if (system.B.cols() != 1 || system.C.rows() != 1)
    throw std::invalid_argument("one input and one output are summed");
  double sum = std::abs(system.D(0, 0));
  if (system.states() == 0) return {sum, sum};
  if (!is_stable(system)) throw std::domain_error("an unstable system has no finite gain");
  const StateSpace s = balanced(system);
  const double factor = tail_factor(s);
  VectorXd x = s.B;
  double tail_before = std::numeric_limits<double>::infinity();
  for (long samples = 0; samples < most_samples; samples += 64) {
    const double tail = factor * x.cwiseAbs().maxCoeff();
    if (tail <= tolerance * sum || tail <= 1e-300) return {sum, sum + tail};
    if (samples % look_ahead == 0) {
      const double left = std::log(tail / (tolerance * sum)) / std::log(tail_before / tail) * look_ahead;
      if (tail >= tail_before || double(samples) + left > most_samples) break;
      tail_before = tail;
    }
    for (int i = 0; i < 64; ++i, x = s.A * x) sum += std::abs(s.C.row(0).dot(x));
  }
  throw std::domain_error("the system forgets too slowly for its gain to be summed");
}

Bounds energy_gain(const StateSpace& system, double tolerance) {
  if (system.states() == 0) {
    const double gain = largest_singular_value(system.D.cast<std::complex<double>>());
    return {gain, gain};
  }
  if (!is_stable(system)) throw std::domain_error("an unstable system has no finite gain");
  const StateSpace s = balanced(bilinear(balanced(system)));
  const FrequencyResponse response(s);
  double lower = std::max(largest_singular_value(response.at(0)),
                          largest_singular_value(s.D.cast<std::complex<double>>()));
  for (double frequency : interesting_frequencies(s, 200))
    lower = std::max(lower, largest_singular_value(response.at(frequency)));
  if (lower == 0) return {};
  for (int i = 0; i < 50; ++i) {
    const double level = lower * (1 + 2 * tolerance);
    const std::vector<double> at = frequencies_at(s, level);
    if (at.empty()) return {lower, level};
    double higher = level;
    for (size_t k = 1; k < at.size(); ++k)
      higher = std::max(higher, largest_singular_value(response.at(0.5 * (at[k - 1] + at[k]))));
    lower = higher;
  }
  throw std::domain_error("the largest gain over frequency could not be bounded");
}

}  // namespace loopwright
