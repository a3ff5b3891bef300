/// The variables on which the remainder depends: smooth functions of each, fitted on some blocks of time and
/// tested on others.
#include <algorithm>
#include <cmath>
#include "tools/diagnose/verdict/verdict.h"
#include "models/real/whole.h"
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

/// The remaining force, and the variables with it; means over a few samples.
struct Remainder {
  std::vector<double> force, position, velocity, acceleration, input, time;
};

Remainder remainder_of(const Trials& trials, const std::vector<Fitted>& fitted) {
  Remainder r;
  for (size_t t = 0; t < trials.list.size(); ++t) {
    const Path& path = fitted[t].prediction.path;
    const size_t together =
        std::max<size_t>(1, whole_count(std::round(criteria::remainder_mean_s / path.sample_time)));
    const std::vector<double>& slow = fitted[t].prediction.slow;
    const auto add = [&](std::vector<double>& list, const std::vector<double>& of, size_t k) {
      double sum = 0;
      for (size_t i = 0; i < together; ++i) sum += of[k + i];
      list.push_back(sum / double(together));
    };
    for (size_t k = 0; k + together < path.samples(); k += together) {
      if (!trials.list[t].usable[k] || !trials.list[t].usable[k + together]) continue;
      add(r.force, slow, k), add(r.position, path.position, k), add(r.velocity, path.velocity, k);
      add(r.acceleration, path.acceleration, k), add(r.input, path.input, k);
      r.time.push_back(double(k) * path.sample_time);
    }
  }
  return r;
}

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

/// Explained share of the remainder on blocks that the smoother was not fitted to, 0 where it predicts worse
/// than nothing; `side` splits it into two smoothers.
double explained(const std::vector<double>& force, const std::vector<double>& variable, size_t knots,
                 size_t block, const std::vector<double>* side) {
  const Hats hats(variable, knots);
  const size_t width = hats.knots.size();
  using criteria::folds;
  double left = 0, whole = 0;
  for (size_t fold = 0; fold < folds; ++fold) {
    const Eigen::Index n = Eigen::Index(width) * (side ? 2 : 1);
    Eigen::MatrixXd G = Eigen::MatrixXd::Identity(n, n) * criteria::ridge;
    Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
    const auto place = [&](size_t i) {
      const auto [hat, weight] = hats.at(variable[i]);
      return std::pair(Eigen::Index(hat + (side && (*side)[i] < 0 ? width : 0)), weight);
    };
    for (size_t i = 0; i < force.size(); ++i) {
      if (i / block % folds == fold) continue;
      const auto [at, w] = place(i);
      if (at + 1 >= n) continue;
      G(at, at) += (1 - w) * (1 - w), G(at + 1, at + 1) += w * w;
      G(at, at + 1) += w * (1 - w), G(at + 1, at) += w * (1 - w);
      b[at] += (1 - w) * force[i], b[at + 1] += w * force[i];
    }
    const Eigen::VectorXd level = G.ldlt().solve(b);
    for (size_t i = 0; i < force.size(); ++i) {
      if (i / block % folds != fold) continue;
      const auto [at, w] = place(i);
      const double seen = at + 1 < n ? (1 - w) * level[at] + w * level[at + 1] : level[at];
      left += (force[i] - seen) * (force[i] - seen), whole += force[i] * force[i];
    }
  }
  return whole > 0 ? std::max(0.0, 1 - left / whole) : 0;
}

}  // namespace

std::vector<RemainderShare> dependence_of(const Trials& trials, const std::vector<Fitted>& fitted) {
  const Remainder r = remainder_of(trials, fitted);
  if (r.force.size() < criteria::least_remainder) return {};
  const double mean_s = std::max(criteria::remainder_mean_s, trials.list.front().model->record().sample_time);
  const size_t block = std::max<size_t>(1, whole_count(std::round(criteria::remainder_block_s / mean_s)));
  std::vector<RemainderShare> list;
  list.push_back({"position", explained(r.force, r.position, criteria::levels_along, block, nullptr)});
  if (!trials.has_map()) {
    list.push_back(
        {"velocity", explained(r.force, r.velocity, criteria::levels_of_velocity, block, nullptr)});
    list.push_back({"acceleration",
                    explained(r.force, r.acceleration, criteria::levels_of_acceleration, block, nullptr)});
    list.push_back({"input", explained(r.force, r.input, criteria::levels_of_acceleration, block, nullptr)});
    list.push_back({"time", explained(r.force, r.time, criteria::levels_along, block, nullptr)});
  }
  const double direction = explained(r.force, r.position, criteria::levels_along, block, &r.velocity);
  if (direction > list.front().share + criteria::least_dependence)
    list.push_back({"position,direction", direction});
  std::ranges::stable_sort(list, std::ranges::greater{}, &RemainderShare::share);
  return list;
}

}  // namespace loopwright::diagnosis
