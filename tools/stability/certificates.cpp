#include "tools/stability/certificates.h"
#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>
#include "models/linear/norms.h"
#include "models/linear/poles.h"
#include "models/linear/structure.h"

namespace loopwright {

using Eigen::Index;
using Eigen::MatrixXd;

double gain_bound(const StateSpace& system, GainOf gain) {
  const StateSpace part = connected_part(system);
  if (!is_stable(part)) return infinity;
  try {
    if (gain == GainOf::energy) return energy_gain(part).upper;
    double largest = 0;
    for (Index o = 0; o < part.C.rows(); ++o) {
      double sum = 0;
      for (Index i = 0; i < part.B.cols(); ++i) sum += peak_to_peak_gain(channel(part, i, o)).upper;
      largest = std::max(largest, sum);
    }
    return largest;
  } catch (const std::domain_error&) {
    return infinity;  // it cannot be bounded
  }
}

namespace {

/// z = Σ weight · port as the only output; stacked sample after sample if the system is lifted.
StateSpace combined(const SampledSystem& system, const FunctionInput& input) {
  const Index ports = Index(input.ports.size());
  StateSpace result = system.matrices;
  result.C = MatrixXd::Zero(system.lifted, system.matrices.C.cols());
  result.D = MatrixXd::Zero(system.lifted, system.matrices.D.cols());
  for (int k = 0; k < system.lifted; ++k)
    for (Index p = 0; p < ports; ++p) {
      result.C.row(k) += input.ports[size_t(p)].second * system.matrices.C.row(k * ports + p);
      result.D.row(k) += input.ports[size_t(p)].second * system.matrices.D.row(k * ports + p);
    }
  return result;
}

}  // namespace

MatrixXd small_gain_matrix(const LinearDiagram& linear, const std::vector<BoundedFunction>& functions,
                           double unit, double sample_time, int subdivisions, GainOf gain) {
  const Index n = Index(functions.size());
  MatrixXd N = MatrixXd::Zero(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index k = 0; k < n; ++k)
      for (const FunctionInput& input : functions[size_t(i)].inputs) {
        if (input.slope == 0) continue;
        Access access{{functions[size_t(k)].output}, {}, {}};
        for (const auto& port : input.ports) access.to.push_back(port.first);
        const SampledSystem system = sampled_system(linear, access, sample_time, subdivisions);
        const double scale = functions[size_t(k)].scales_with_alpha ? 1 / unit : 1;
        N(i, k) += input.slope * scale * gain_bound(combined(system, input), gain);
      }
  return N;
}

double spectral_radius(MatrixXd gains, const std::vector<BoundedFunction>& functions, double alpha) {
  if (gains.size() == 0) return 0;
  for (Index k = 0; k < gains.cols(); ++k)
    if (functions[size_t(k)].scales_with_alpha) gains.col(k) *= alpha;
  if (!gains.allFinite()) return infinity;
  return gains.eigenvalues().cwiseAbs().maxCoeff();
}

Certificate certify(const MatrixXd& gains, const std::vector<BoundedFunction>& functions, double alpha) {
  const auto radius = [&](double a) { return spectral_radius(gains, functions, a); };
  Certificate certificate;
  certificate.radius = radius(alpha), certificate.radius_without = radius(0);
  certificate.holds = certificate.radius < 1;
  if (!(certificate.radius_without < 1)) return certificate;
  double low = 0, high = 1;
  while (radius(high) < 1 && high < 1e12) high *= 2;
  certificate.largest_alpha = infinity;
  if (radius(high) < 1) return certificate;
  for (int i = 0; i < 100; ++i) (radius(0.5 * (low + high)) < 1 ? low : high) = 0.5 * (low + high);
  certificate.largest_alpha = low;
  return certificate;
}

}  // namespace loopwright
