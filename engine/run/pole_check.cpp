#include "engine/run/pole_check.h"
#include <fmt/format.h>
#include "models/linear/decompositions.h"

namespace loopwright {

FastestPole fastest_pole(Run<double>& run) {
  const int n = run.plan().states;
  if (n == 0 || n > 200) return {};  // the cost grows as n³
  const std::vector<double> x(run.states().begin(), run.states().end());
  const double time = run.now().time;
  Eigen::MatrixXd jacobian(n, n);
  std::vector<double> shifted = x, above(x.size()), below(x.size());
  for (int j = 0; j < n; ++j) {
    const double h = 1e-6 * std::max(std::abs(x[size_t(j)]), 1e-3);
    shifted[size_t(j)] = x[size_t(j)] + h;
    run.derivatives_at(time, shifted.data(), above.data());
    shifted[size_t(j)] = x[size_t(j)] - h;
    run.derivatives_at(time, shifted.data(), below.data());
    shifted[size_t(j)] = x[size_t(j)];
    for (int i = 0; i < n; ++i) jacobian(i, j) = (above[size_t(i)] - below[size_t(i)]) / (2 * h);
  }
  run.derivatives_at(time, x.data(), above.data());  // restores the signals
  if (!jacobian.allFinite()) return {};
  const auto [values, vectors] = eigensystem(jacobian);
  FastestPole fastest;
  for (int i = 0; i < n; ++i) {
    const std::complex<double> pole = values[i];
    if (std::abs(pole) <= fastest.magnitude) continue;
    Eigen::Index state = 0;
    vectors.col(i).cwiseAbs().maxCoeff(&state);
    fastest = {std::abs(pole), pole.real(), pole.imag(), int(state)};
  }
  return fastest;
}

std::string step_warning(const Plan& plan, const FastestPole& pole) {
  if (!is_fixed_step(plan.method) || pole.magnitude == 0 || pole.real > 0) return {};
  const double h = plan.clock.time(plan.step_ticks);
  const MethodFacts& method = facts(plan.method);
  const bool is_real = std::abs(pole.imaginary) < 1e-6 * pole.magnitude;
  const double limit =
      is_real || method.any_stability_limit == 0 ? method.real_stability_limit : method.any_stability_limit;
  if (h * pole.magnitude <= 0.9 * limit) return {};
  const std::string& block = plan.blocks[size_t(plan.block_of_state[size_t(pole.state)])].path;
  return fmt::format(
      "the step of {:g} s is {} for the fastest pole, {:.4g} rad/s in \"{}\": {} is stable up to {:.3g} s; "
      "take a shorter \"step\", or \"dopri5\" or \"cvode-bdf\"",
      h, h * pole.magnitude > limit ? "too long" : "near the limit", pole.magnitude, block, method.name,
      limit / pole.magnitude);
}

}  // namespace loopwright
