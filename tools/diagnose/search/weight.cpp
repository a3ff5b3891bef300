#include "tools/diagnose/search/weight.h"
#include <algorithm>
#include <cmath>
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/whiteness.h"

namespace loopwright::diagnosis {

using namespace criteria;

std::vector<Member> without_one(std::vector<Member> members, size_t index) {
  members.erase(members.begin() + std::ptrdiff_t(index));
  return members;
}

namespace {

/// The 95 % quantile of χ² with so many degrees of freedom (Wilson and Hilferty 1931).
double chi_square_95(double n) {
  const double cube_root = 1 - 2 / (9 * n) + 1.645 * std::sqrt(2 / (9 * n));
  return n * cube_root * cube_root * cube_root;
}

/// Indices of a member's parameters among the free ones. Only those that decide whether it is present: the
/// linear ones, or the shape of a member without linear ones.
std::vector<Eigen::Index> existence(const std::vector<Member>& members, size_t member) {
  std::vector<Eigen::Index> places;
  const std::vector<FreeParameter> free = free_parameters(members);
  const bool by_shape = members[member].candidate->amplitude_is_one;
  for (size_t i = 0; i < free.size(); ++i)
    if (free[i].member == member && free[i].is_linear != by_shape) places.push_back(Eigen::Index(i));
  return places;
}

/// Quadratic form of theta with the inverse of the covariance that remains when the parameters at `known` are
/// known and those at neither `known` nor `places` are estimated with them.
double chi_square(const Eigen::MatrixXd& information, const Eigen::VectorXd& theta,
                  const std::vector<Eigen::Index>& places, const std::vector<Eigen::Index>& known) {
  std::vector<Eigen::Index> free = places;
  for (Eigen::Index i = 0; i < information.rows(); ++i)
    if (std::ranges::find(places, i) == places.end() && std::ranges::find(known, i) == known.end())
      free.push_back(i);
  const Eigen::MatrixXd covariance = information(free, free).inverse();
  const Eigen::Index n = Eigen::Index(places.size());
  const Eigen::VectorXd at = theta(places);
  return at.dot(covariance.topLeftCorner(n, n).ldlt().solve(at));
}

/// χ² of the parameters that decide whether a member is present, alone and with all others known. Its own
/// shape is taken as known: a drift much longer than the record is certain even if its size and time are not
/// determined separately.
struct Wald {
  double among_others = 0, alone = 0, with_own_shape = 0;
  size_t parameters = 0;
};
Wald wald(Estimate& estimate, size_t member) {
  const std::vector<FreeParameter> free = free_parameters(estimate.members);
  const std::vector<Eigen::Index> places = existence(estimate.members, member);
  const Eigen::VectorXd scale = estimate.covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd correlation = scale.asDiagonal() * estimate.covariance * scale.asDiagonal();
  const Eigen::MatrixXd information = scale.asDiagonal() * correlation.inverse() * scale.asDiagonal();
  Eigen::VectorXd theta(Eigen::Index(free.size()));
  std::vector<Eigen::Index> shape, others;
  for (size_t i = 0; i < free.size(); ++i) {
    const Eigen::Index at = Eigen::Index(i);
    theta[at] = value_of(estimate.members, free[i]);
    if (std::ranges::find(places, at) != places.end()) continue;
    others.push_back(at);
    if (free[i].member == member) shape.push_back(at);
  }
  return {chi_square(information, theta, places, shape), chi_square(information, theta, places, others),
          chi_square(information, theta, places, {}), places.size()};
}

/// Gain in the squared errors by the parameters at these places, as Jᵀ J and Jᵀ e tell.
double gain_of(const NormalEquations& e, const std::vector<Eigen::Index>& places) {
  if (places.empty()) return 0;
  const Eigen::VectorXd scale = e.G.diagonal()(places).cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd G = scale.asDiagonal() * e.G(places, places).eval() * scale.asDiagonal();
  G.diagonal().array() += 1e-9;
  const Eigen::VectorXd b = scale.cwiseProduct(e.b(places).eval());
  return b.dot(G.ldlt().solve(b));
}

/// χ² of a member as wald() has it, in errors without it: its shape known, the other members fitted beside
/// it.
double gain_of_member(const NormalEquations& e, const std::vector<Member>& members, size_t member) {
  const std::vector<FreeParameter> free = free_parameters(members);
  const std::vector<Eigen::Index> places = existence(members, member);
  std::vector<Eigen::Index> others;
  for (size_t i = 0; i < free.size(); ++i)
    if (free[i].member != member) others.push_back(Eigen::Index(i));
  std::vector<Eigen::Index> all = others;
  all.insert(all.end(), places.begin(), places.end());
  return std::max(0.0, gain_of(e, all) - gain_of(e, others));
}

std::vector<double> sum_of_columns(const Member& member, const Path& path) {
  const Columns columns = member.candidate->columns(path, member.nonlinear);
  std::vector<double> sum(columns[0].mean->size());
  for (size_t c = 0; c < columns.size(); ++c)
    for (size_t k = 0; k < sum.size(); ++k) sum[k] += member.linear[c] * double((*columns[c].mean)[k]);
  return sum;
}

/// The input of a path is what the members made of the recorded one: a limit would find nothing above it.
std::vector<double> change_of_input(const std::vector<Member>& members, size_t index, const Path& path,
                                    const std::vector<double>& raw) {
  std::vector<double> change = drives_of(members, path, raw).input;
  const std::vector<double> without = drives_of(without_one(members, index), path, raw).input;
  for (size_t k = 0; k < change.size(); ++k) change[k] -= without[k];
  return change;
}

/// Root mean square of the force that a member consumes over the fitted rows.
double force_rms(const Trials& trials, const Estimate& estimate, size_t index) {
  const Member& member = estimate.members[index];
  double sum = 0, n = 0;
  for (size_t t = 0; t < trials.list.size(); ++t) {
    const Trial& trial = trials.list[t];
    const Fitted& fitted = (*estimate.fitted)[t];
    std::vector<double> seen;
    if (member.candidate->acts == Acts::input) {
      seen = change_of_input(estimate.members, index, *estimate.motion.paths[t], trial.input);
      for (double& u : seen) u *= trial.model->force_per_input();
    } else {
      seen = sum_of_columns(member, *estimate.motion.paths[t]);
    }
    if (member.candidate->acts == Acts::sensor) {
      const Column feigned(std::vector<float>(seen.begin(), seen.end()));
      const Column* const one = &feigned;
      seen = responses(fitted.axis, fitted.gains, fitted.prediction.path, Acts::sensor, {&one, 1}).front();
      for (double& e : seen) e *= force_of_an_error(estimate.noise);
    }
    for (size_t k = 0; k < trial.held_out_from; ++k)
      if (trial.usable[k]) sum += seen[k] * seen[k], n += 1;
  }
  return std::sqrt(sum / std::max(n, 1.0));
}

/// Of a load that is a state of the predictor: what is lost without it. Where it is known from moment to
/// moment, its mass alone shows little of what the load as a whole explains.
double gain_of_load(Trials& trials, const Estimate& estimate, size_t member) {
  constexpr int iterations = 2;
  const Estimate without =
      fit_members(trials, without_one(estimate.members, member), estimate.noise, estimate.motion, iterations);
  return without.is_valid ? std::max(0.0, without.profile - estimate.profile) : 0;
}

Weight weigh(Trials& trials, Estimate& estimate, size_t member) {
  Weight weight;
  auto [among_others, alone, with_own_shape, parameters] = wald(estimate, member);
  if (estimate.fitted->front().flying == estimate.members[member].candidate) {
    const double as_a_whole = std::max(1.0, gain_of_load(trials, estimate, member) / among_others);
    among_others *= as_a_whole, alone *= as_a_whole;
  }
  weight.wald = among_others;
  weight.certainty = with_own_shape / chi_square_95(double(parameters));
  weight.force_rms = force_rms(trials, estimate, member);
  weight.unique_force = weight.force_rms * std::sqrt(std::min(1.0, among_others / std::max(alone, 1e-300)));
  return weight;
}

}  // namespace

double force_of_an_error(const Noise& noise) {
  return is_soon_forgotten(noise) ? std::hypot(noise.white, noise.slow()) : noise.white;
}

double judged_numbers(const Trials& trials) {
  const double sample_time = trials.list.front().model->record().sample_time;
  return double(fitted_numbers(trials)) * std::min(1.0, sample_time / judged_row_s);
}

double material(const Trials& trials, const Estimate& estimate, const Weight& weight) {
  const double n = judged_numbers(trials);
  const double white =
      estimate.noise.white * std::sqrt(n / double(std::max<size_t>(1, fitted_numbers(trials))));
  const double least_force_now =
      std::max(least_force * trials.force_rms,
               std::min(least_force_to_noise * white, force_that_matters * trials.force_rms));
  // A delay acts only for moments, but is clearly visible.
  const double size = std::max(weight.force_rms / least_force_now, weight.wald / (plain_wald_per_row * n));
  return std::min(
      {weight.wald / std::max({least_wald, least_wald_per_row * n, clear_of_counts * weight.counts}), size,
       weight.unique_force / (least_unique_force * trials.force_rms)});
}

std::vector<Weight> weigh_all(Trials& trials, Estimate& estimate) {
  work_out_covariance(trials, estimate);
  const double color = portmanteau(trials, *estimate.fitted);
  if (color > most_portmanteau_of_search) widen_by_blocks(trials, estimate);
  refer_to_zero(estimate);
  std::vector<Weight> weights;
  for (size_t m = 0; m < estimate.members.size(); ++m) weights.push_back(weigh(trials, estimate, m));
  if (color > most_portmanteau_of_counted) weigh_counts(trials, estimate, weights);
  return weights;
}

void weigh_counts(const Trials& trials, const Estimate& estimate, std::vector<Weight>& weights) {
  if (weights.empty()) return;
  const WhitenedErrors errors = errors_of_counts(trials, estimate);
  if (errors.empty()) return;
  const NormalEquations of_counts = normal_equations(trials, estimate, errors);
  for (size_t m = 0; m < weights.size(); ++m)
    weights[m].counts = gain_of_member(of_counts, estimate.members, m);
}

}  // namespace loopwright::diagnosis
