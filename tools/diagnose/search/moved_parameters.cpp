#include "tools/diagnose/search/moved_parameters.h"
#include <algorithm>
#include <bit>
#include <cmath>
#include <set>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

/// In -2 ln L, and [of the parameter]: smaller changes are none.
constexpr double least_gain_of_parameters = 25, least_change = 2e-3;
constexpr size_t fitted_sets = 4;
/// Sets of them are bits of a word.
constexpr size_t most_free = 31;
/// More free parameters are taken one at a time.
constexpr size_t most_for_all_subsets = 12;
/// [of a parameter] Directions that the record does not determine.
constexpr double undetermined = 10;

/// Of the free factors, with everything else fitted.
Eigen::MatrixXd covariance_of_factors(const Eigen::MatrixXd& J, double variance, Eigen::Index count) {
  Eigen::MatrixXd information = J.transpose() * J / variance;
  for (Eigen::Index i = 0; i < information.rows(); ++i)
    information(i, i) = information(i, i) * (1 + 1e-10) + (i < count ? 1 / (undetermined * undetermined) : 0);
  Eigen::VectorXd size = information.diagonal().cwiseSqrt();
  for (double& s : size)
    if (!(s > 0)) s = 1;
  const Eigen::MatrixXd unit =
      size.cwiseInverse().asDiagonal() * information * size.cwiseInverse().asDiagonal();
  const Eigen::MatrixXd inverse = size.cwiseInverse().asDiagonal() *
                                  unit.completeOrthogonalDecomposition().pseudoInverse() *
                                  size.cwiseInverse().asDiagonal();
  return inverse.topLeftCorner(count, count);
}

/// Cost in -2 ln L of fixing those not in the set.
double cost_of_fixing(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& deviation, uint32_t set) {
  std::vector<Eigen::Index> fixed;
  for (Eigen::Index i = 0; i < deviation.size(); ++i)
    if (!(set >> i & 1)) fixed.push_back(i);
  if (fixed.empty()) return 0;
  const Eigen::MatrixXd part = covariance(fixed, fixed);
  const Eigen::VectorXd by = deviation(fixed);
  return by.dot(part.ldlt().solve(by));
}

std::vector<uint32_t> promising_sets(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& deviation,
                                     double readings) {
  const auto count = size_t(deviation.size());
  const uint32_t full = uint32_t((uint64_t(1) << count) - 1);
  std::vector<std::pair<double, uint32_t>> ranked;
  const auto add = [&](uint32_t set) {
    ranked.emplace_back(cost_of_fixing(covariance, deviation, set) +
                            std::popcount(set) * (std::log(readings) + cost_of_parameter),
                        set);
  };
  if (count <= most_for_all_subsets) {
    for (uint32_t set = 0; set <= full; ++set) add(set);
  } else {
    for (size_t i = 0; i < count; ++i) add(1u << i);
    for (uint32_t set = full; set;) {  // the least important first
      add(set);
      uint32_t best = 0;
      double least = 1e300;
      for (size_t i = 0; i < count; ++i)
        if (set >> i & 1)
          if (const double cost = cost_of_fixing(covariance, deviation, set & ~(1u << i)); cost < least)
            least = cost, best = set & ~(1u << i);
      set = best;
    }
  }
  std::ranges::sort(ranked);
  std::set<uint32_t> sets{0};
  for (size_t i = 0; i < std::min(fitted_sets, ranked.size()); ++i) sets.insert(ranked[i].second);
  const double most = ranked.front().first + criteria::hopeless_parameter;
  for (const auto& [cost, set] : ranked)
    if (std::has_single_bit(set) && cost < most) sets.insert(set);
  return {sets.begin(), sets.end()};
}

}  // namespace

std::vector<MovedParameters> moved_parameters(SiteFitter& fitter, const SiteHypothesis& all_free,
                                              double readings) {
  SiteHypothesis start = all_free;
  fitter.refine(start, 4, true);
  SitePass pass;
  if (!fitter.pass(start, false, pass)) return {};
  std::vector<int> free;
  for (size_t i = 0; i < start.is_free.size(); ++i)
    if (start.is_free[i]) free.push_back(int(i));
  if (free.size() > most_free) {  // those that moved furthest stay; sets are bits
    std::ranges::stable_sort(free, std::greater{},
                             [&](int i) { return std::abs(start.factors[size_t(i)] - 1); });
    for (size_t i = most_free; i < free.size(); ++i)
      start.is_free[size_t(free[i])] = false, start.factors[size_t(free[i])] = 1;
    free.resize(most_free);
    std::ranges::sort(free);
    fitter.refine(start, 4, true);
    if (!fitter.pass(start, false, pass)) return {};
  }
  std::vector<uint32_t> sets{0};
  if (!free.empty()) {
    const Eigen::MatrixXd J = fitter.jacobian(start, pass);
    Eigen::VectorXd deviation(Eigen::Index(free.size()));
    for (size_t i = 0; i < free.size(); ++i) deviation[Eigen::Index(i)] = start.factors[size_t(free[i])] - 1;
    const Eigen::MatrixXd covariance =
        covariance_of_factors(J, pass.squares / double(pass.readings), Eigen::Index(free.size()));
    sets = promising_sets(covariance, deviation, readings);
  }
  std::vector<MovedParameters> list;
  for (uint32_t set : sets) {
    MovedParameters choice{start, 0};
    SiteHypothesis& h = choice.hypothesis;
    for (size_t i = 0; i < free.size(); ++i)
      if (!(set >> i & 1)) h.is_free[size_t(free[i])] = false, h.factors[size_t(free[i])] = 1;
    fitter.refine(h, 8, false);
    fitter.fit_noise(h);
    fitter.refine(h, 3, false);
    if (!std::isfinite(h.objective)) continue;
    choice.criterion = h.objective + double(h.free_parameters()) * (std::log(readings) + cost_of_parameter);
    list.push_back(std::move(choice));
  }
  std::ranges::sort(list, {}, &MovedParameters::criterion);
  const std::vector<MovedParameters> all = list;
  // A parameter that gains little or hardly moves has not moved.
  const auto is_immaterial = [&](const MovedParameters& choice) {
    return std::ranges::any_of(choice.moved(), [&](int i) {
      if (std::abs(choice.hypothesis.factors[size_t(i)] - 1) < least_change) return true;
      return std::ranges::any_of(all, [&](const MovedParameters& other) {
        std::vector<int> without = choice.moved();
        std::erase(without, i);
        return other.moved() == without &&
               other.hypothesis.objective - choice.hypothesis.objective < least_gain_of_parameters;
      });
    });
  };
  std::erase_if(list, is_immaterial);
  return list.empty() ? all : list;
}

}  // namespace loopwright::diagnosis
