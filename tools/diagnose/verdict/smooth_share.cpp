#include "tools/diagnose/verdict/smooth_share.h"
#include <Eigen/Dense>
#include <algorithm>
#include "models/real/whole.h"
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

/// Hat functions over the quantiles of a variable: the two nonzero ones, and their weights.
struct Hats {
  std::vector<double> knots;
  Hats(std::vector<double> values, size_t count) {
    std::ranges::sort(values);
    for (size_t i = 0; i < count; ++i) {
      const double knot =
          values[whole_index(double(values.size() - 1) * double(i) / double(count - 1), values.size())];
      if (knots.empty() || knot > knots.back()) knots.push_back(knot);
    }
  }
  std::pair<size_t, double> at(double x) const {
    if (knots.size() < 2 || x <= knots.front()) return {0, 0};
    if (x >= knots.back()) return {knots.size() - 2, 1};
    const size_t i = size_t(std::ranges::upper_bound(knots, x) - knots.begin()) - 1;
    return {i, (x - knots[i]) / (knots[i + 1] - knots[i])};
  }
};

}  // namespace

double smooth_share(std::span<const double> signal, std::span<const double> variable, size_t levels,
                    size_t block, std::span<const double> side) {
  const Hats hats({variable.begin(), variable.end()}, levels);
  const size_t width = hats.knots.size();
  using criteria::folds;
  double left = 0, whole = 0;
  for (size_t fold = 0; fold < folds; ++fold) {
    const Eigen::Index n = Eigen::Index(width) * (side.empty() ? 1 : 2);
    Eigen::MatrixXd G = Eigen::MatrixXd::Identity(n, n) * criteria::ridge;
    Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
    const auto place = [&](size_t i) {
      const auto [hat, weight] = hats.at(variable[i]);
      return std::pair(Eigen::Index(hat + (!side.empty() && side[i] < 0 ? width : 0)), weight);
    };
    for (size_t i = 0; i < signal.size(); ++i) {
      if (i / block % folds == fold) continue;
      const auto [at, w] = place(i);
      if (at + 1 >= n) continue;
      G(at, at) += (1 - w) * (1 - w), G(at + 1, at + 1) += w * w;
      G(at, at + 1) += w * (1 - w), G(at + 1, at) += w * (1 - w);
      b[at] += (1 - w) * signal[i], b[at + 1] += w * signal[i];
    }
    const Eigen::VectorXd level = G.ldlt().solve(b);
    for (size_t i = 0; i < signal.size(); ++i) {
      if (i / block % folds != fold) continue;
      const auto [at, w] = place(i);
      const double seen = at + 1 < n ? (1 - w) * level[at] + w * level[at + 1] : level[at];
      left += (signal[i] - seen) * (signal[i] - seen), whole += signal[i] * signal[i];
    }
  }
  return whole > 0 ? std::max(0.0, 1 - left / whole) : 0;
}

}  // namespace loopwright::diagnosis
