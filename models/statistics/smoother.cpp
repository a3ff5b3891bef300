#include "models/statistics/smoother.h"
#include <Eigen/Cholesky>
#include <algorithm>
#include "models/real/whole.h"

namespace loopwright {
namespace {

/// [mean square of a column] Hats on which no row lies stay at zero, and no other one is bent.
constexpr double ridge = 1e-3;

struct NormalEquations {
  Eigen::MatrixXd G;
  Eigen::VectorXd b;
  explicit NormalEquations(Eigen::Index n) : G(Eigen::MatrixXd::Zero(n, n)), b(Eigen::VectorXd::Zero(n)) {}

  void add(const Hats::Place& place, double value) {
    const Eigen::Index at = Eigen::Index(place.knot);
    const double w = place.weight;
    G(at, at) += (1 - w) * (1 - w), b[at] += (1 - w) * value;
    if (w == 0) return;
    G(at, at + 1) += w * (1 - w), G(at + 1, at) += w * (1 - w), G(at + 1, at + 1) += w * w;
    b[at + 1] += w * value;
  }
};

double at(const Hats::Place& place, const Eigen::VectorXd& levels) {
  const Eigen::Index knot = Eigen::Index(place.knot);
  const double low = (1 - place.weight) * levels[knot];
  return place.weight == 0 ? low : low + place.weight * levels[knot + 1];
}

}  // namespace

Hats Hats::at_equal_distances(std::span<const double> values, size_t knots) {
  Hats hats;
  if (values.empty()) return hats;
  const auto [least, most] = std::ranges::minmax(values);
  for (size_t i = 0; i < knots && (i == 0 || most > least); ++i)
    hats.knots_.push_back(least + (most - least) * double(i) / double(knots - 1));
  return hats;
}

Hats Hats::between_quantiles(std::span<const double> values, size_t knots) {
  Hats hats;
  std::vector<double> ranked(values.begin(), values.end());
  std::ranges::sort(ranked);
  for (size_t i = 0; i < knots && !ranked.empty(); ++i) {
    const double share = double(i) / double(knots - 1);
    const double knot = ranked[whole_index(double(ranked.size() - 1) * share, ranked.size())];
    if (hats.knots_.empty() || knot > hats.knots_.back()) hats.knots_.push_back(knot);
  }
  return hats;
}

Hats::Place Hats::at(double value) const {
  if (knots_.size() < 2 || !(value > knots_.front())) return {0, 0};  // nor of what is no number
  if (value >= knots_.back()) return {knots_.size() - 2, 1};
  const size_t i = size_t(std::ranges::upper_bound(knots_, value) - knots_.begin()) - 1;
  return {i, (value - knots_[i]) / (knots_[i + 1] - knots_[i])};
}

double CrossValidation::share_of(std::span<const double> signal) const {
  const Eigen::Index n = Eigen::Index(columns);
  std::vector<NormalEquations> of_fold(folds, NormalEquations(n));
  for (size_t i = 0; i < signal.size(); ++i) of_fold[fold[i]].add(places[i], signal[i]);
  NormalEquations all(n);
  for (const NormalEquations& one : of_fold) all.G += one.G, all.b += one.b;
  const double stiffness = ridge * all.G.trace() / double(n) + 1e-12;
  std::vector<Eigen::VectorXd> levels;
  for (const NormalEquations& one : of_fold) {
    Eigen::MatrixXd G = all.G - one.G;
    G.diagonal().array() += stiffness;
    levels.push_back(G.ldlt().solve(all.b - one.b));
  }
  double before = 0, after = 0;
  for (size_t i = 0; i < signal.size(); ++i) {
    const double left = signal[i] - loopwright::at(places[i], levels[fold[i]]);
    before += signal[i] * signal[i], after += left * left;
  }
  return before > 0 ? 1 - after / before : 0;
}

}  // namespace loopwright
