#include "tools/diagnose/search/moved_parameters.h"
#include <algorithm>
#include <bit>
#include <cmath>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

/// [of the parameter] Smaller changes are none.
constexpr double least_change = 2e-3;
constexpr size_t fitted_sets = 4, fitted_singles = 3;
/// Sets of them are bits of a word.
constexpr size_t most_free = 31;
/// More free parameters are taken one at a time.
constexpr size_t most_for_all_subsets = 12;
/// [of a parameter] Directions that the record does not determine.
constexpr double undetermined = 10;

/// Of the free factors, with everything else fitted, and the standard deviation of what is stated.
Eigen::MatrixXd covariance_of_factors(const Eigen::MatrixXd& J, double variance, Eigen::Index count,
                                      double stated) {
  Eigen::MatrixXd information = J.transpose() * J / variance;
  for (Eigen::Index i = 0; i < information.rows(); ++i)
    information(i, i) = information(i, i) * (1 + 1e-10) + (i < count ? 1 / (stated * stated) : 0);
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

/// Of the free factors, in their order.
std::vector<double> standard_errors(SiteFitter& fitter, SiteHypothesis h) {
  const size_t count = h.free_parameters();
  SitePass pass;
  if (count == 0 || !fitter.pass(h, false, pass))
    return std::vector<double>(count, criteria::deviation_of_stated_parameter);
  const Eigen::MatrixXd covariance =
      covariance_of_factors(fitter.jacobian(h, pass), pass.squares / double(pass.readings),
                            Eigen::Index(count), criteria::deviation_of_stated_parameter);
  std::vector<double> list;
  for (size_t i = 0; i < count; ++i) list.push_back(std::sqrt(covariance(Eigen::Index(i), Eigen::Index(i))));
  return list;
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

/// The most promising first; the empty one is among them.
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
    add(0);
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
  std::vector<uint32_t> sets;
  const double most = ranked.front().first + criteria::hopeless_parameter;
  size_t singles = 0;  // the form is far off where parameters have moved together along what they leave open
  for (const auto& [cost, set] : ranked) {
    const bool is_promising_single = std::has_single_bit(set) && (cost < most || singles++ < fitted_singles);
    if (sets.size() < fitted_sets || is_promising_single || set == 0) sets.push_back(set);
  }
  return sets;
}

void put_back(SiteHypothesis& h, int parameter) {
  h.is_free[size_t(parameter)] = false, h.factors[size_t(parameter)] = 1;
}

/// With its own noise; nothing if it diverges.
std::optional<MovedParameters> fitted(SiteFitter& fitter, SiteHypothesis h, double readings) {
  fitter.refine(h, 8);
  fitter.fit_noise(h);
  fitter.refine(h, 3);
  if (!std::isfinite(h.objective)) return {};
  const double cost = double(h.free_parameters()) * (std::log(readings) + cost_of_parameter);
  MovedParameters choice{std::move(h), 0};
  choice.criterion = choice.hypothesis.objective + cost;
  choice.standard_errors = standard_errors(fitter, choice.hypothesis);
  return choice;
}

/// The list stays in the order of the criterion.
void add(std::vector<MovedParameters>& list, std::optional<MovedParameters> choice) {
  if (!choice) return;
  const auto place = std::ranges::upper_bound(list, choice->criterion, {}, &MovedParameters::criterion);
  list.insert(place, std::move(*choice));
}

/// [standard errors] By which the i-th of the moved parameters is off.
double significance(const MovedParameters& choice, size_t i) {
  const auto parameter = size_t(choice.moved()[i]);
  return std::abs(choice.hypothesis.factors[parameter] - 1) / choice.standard_errors[i];
}

/// Sets are proposed by a quadratic form about one point, far from which it may miss the simpler one: the
/// best is fitted again without its least certain parameter as long as that is not sure to have moved.
void put_idle_ones_back(std::vector<MovedParameters>& list, SiteFitter& fitter, double readings) {
  while (!list.empty() && !list.front().moved().empty() && !fitter.is_interrupted() &&
         !fitter.model().work().is_spent(1)) {
    const MovedParameters best = list.front();
    std::vector<int> without = best.moved();
    size_t idle = 0;
    for (size_t i = 1; i < without.size(); ++i)
      if (significance(best, i) < significance(best, idle)) idle = i;
    if (squared(significance(best, idle)) >= criteria::least_gain_of_parameter) return;
    SiteHypothesis h = best.hypothesis;
    put_back(h, without[idle]);
    without.erase(without.begin() + std::ptrdiff_t(idle));
    if (std::ranges::any_of(list, [&](const auto& known) { return known.moved() == without; })) return;
    add(list, fitted(fitter, std::move(h), readings));
  }
}

/// A parameter that gains little, hardly moves or may be as it is stated has not moved.
bool is_immaterial(const MovedParameters& choice, const std::vector<MovedParameters>& all) {
  const std::vector<int> moved = choice.moved();
  for (size_t i = 0; i < moved.size(); ++i) {
    if (std::abs(choice.hypothesis.factors[size_t(moved[i])] - 1) < least_change) return true;
    if (significance(choice, i) < criteria::within_interval) return true;
    std::vector<int> without = moved;
    without.erase(without.begin() + std::ptrdiff_t(i));
    const bool gains_little = std::ranges::any_of(all, [&](const MovedParameters& other) {
      return other.moved() == without &&
             other.hypothesis.objective - choice.hypothesis.objective < criteria::least_gain_of_parameter;
    });
    if (gains_little) return true;
  }
  return false;
}

}  // namespace

std::vector<MovedParameters> moved_parameters(SiteFitter& fitter, const SiteHypothesis& all_free,
                                              double readings) {
  SiteHypothesis start = all_free;
  fitter.refine(start, 4);
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
    fitter.refine(start, 4);
    if (!fitter.pass(start, false, pass)) return {};
  }
  std::vector<uint32_t> sets{0};
  if (!free.empty()) {
    const Eigen::MatrixXd J = fitter.jacobian(start, pass);
    Eigen::VectorXd deviation(Eigen::Index(free.size()));
    for (size_t i = 0; i < free.size(); ++i) deviation[Eigen::Index(i)] = start.factors[size_t(free[i])] - 1;
    const Eigen::MatrixXd covariance = covariance_of_factors(J, pass.squares / double(pass.readings),
                                                             Eigen::Index(free.size()), undetermined);
    sets = promising_sets(covariance, deviation, readings);
  }
  if (fitter.model().work().is_spent(1)) sets.resize(1);
  std::vector<std::optional<MovedParameters>> choices(sets.size());
  fitter.side_by_side(sets.size(), [&](SiteFitter& own, size_t s) {
    SiteHypothesis h = start;
    for (size_t i = 0; i < free.size(); ++i)
      if (!(sets[s] >> i & 1)) put_back(h, free[i]);
    choices[s] = fitted(own, std::move(h), readings);
  });
  std::vector<MovedParameters> list;
  for (std::optional<MovedParameters>& choice : choices) add(list, std::move(choice));
  put_idle_ones_back(list, fitter, readings);
  const std::vector<MovedParameters> all = list;
  std::erase_if(list, [&](const MovedParameters& choice) { return is_immaterial(choice, all); });
  return list.empty() ? all : list;
}

}  // namespace loopwright::diagnosis
