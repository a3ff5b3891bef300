#include "tools/diagnose/search/maximum_likelihood.h"
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/remembered_runs.h"
#include "tools/diagnose/search/rest.h"
#include "models/real/whole.h"
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace loopwright::diagnosis {
namespace {

using criteria::same_motion;

/// The rows of a part of a record that are fitted.
std::vector<size_t> fitted_rows(const Trial& trial, size_t first, size_t count) {
  std::vector<size_t> rows;
  for (size_t k = first; k < std::min(first + count, trial.held_out_from); ++k)
    if (trial.usable[k]) rows.push_back(k);
  return rows;
}

/// Jᵀ J and Jᵀ e over the fitted rows of all records; `error`: whitened, of a record.
template <class Error>
NormalEquations normal_equations_of(const Trials& trials, const Estimate& estimate, Error&& error) {
  const Eigen::Index n = Eigen::Index(free_parameters(estimate.members).size());
  NormalEquations equations{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  const size_t ports = trials.ports();
  const auto sensitivities =
      trials.remembered->sensitivities(trials, estimate.members, estimate.motion, estimate.fitted);
  for (size_t t = 0; t < trials.list.size(); ++t) {
    const Trial& trial = trials.list[t];
    const Sensitivity& s = (*sensitivities)[t];
    const std::vector<double>& white = error(t);
    trials.work->add(white.size(), double(n * n) * Work::of_a_product);
    constexpr size_t chunk = 1024;
    Eigen::MatrixXd rows(Eigen::Index(chunk * ports), n + 1);
    for (size_t start = 0; start < trial.held_out_from; start += chunk) {
      const std::vector<size_t> counted = fitted_rows(trial, start, chunk);
      if (counted.empty()) continue;  // the product expects rows
      const auto fill = [&](Eigen::Index column, const std::vector<double>& numbers) {
        double* to = &rows(0, column);
        for (const size_t k : counted)
          for (size_t p = k * ports; p < (k + 1) * ports; ++p) *to++ = numbers[p];
      };
      for (Eigen::Index c = 0; c < n; ++c) fill(c, s.columns[size_t(c)]);
      fill(n, white);
      const Eigen::Index r = Eigen::Index(counted.size() * ports);
      equations.G.selfadjointView<Eigen::Lower>().rankUpdate(rows.topRows(r).leftCols(n).transpose());
      equations.b.noalias() += rows.topRows(r).leftCols(n).transpose() * rows.topRows(r).col(n);
    }
  }
  equations.G = equations.G.selfadjointView<Eigen::Lower>().toDenseMatrix();
  return equations;
}

NormalEquations normal_equations(const Trials& trials, const Estimate& estimate) {
  return normal_equations_of(
      trials, estimate, [&](size_t t) -> const std::vector<double>& { return (*estimate.fitted)[t].white; });
}

/// Solves with columns scaled to one and a ridge that affects only dependent columns.
Eigen::VectorXd solve(const Eigen::MatrixXd& G, const Eigen::VectorXd& b) {
  const Eigen::VectorXd scale = G.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  Eigen::MatrixXd scaled = scale.asDiagonal() * G * scale.asDiagonal();
  scaled.diagonal().array() += 1e-9;
  return scale.asDiagonal() * scaled.ldlt().solve(scale.asDiagonal() * b);
}

/// Where a parameter may be after a step: within its range, and shapes move at most by a third at a time.
std::pair<double, double> reach_of(std::vector<Member>& members, const FreeParameter& parameter) {
  const CandidateParameter& range = range_of(members, parameter);
  if (parameter.is_linear) return {range.low, range.high};
  const double value = value_of(members, parameter);
  const double most = range.span > 0      ? 0.2 * value * value / range.span
                      : range.logarithmic ? std::abs(value) / 3
                                          : (range.high - range.low) / 6;
  return {std::max(range.low, value - most), std::min(range.high, value + most)};
}

/// The step within the reach of all parameters: one that would go farther is set to its end, and the others
/// are solved again. Clipping it alone would disturb all that balance it.
Eigen::VectorXd step_in_range(const NormalEquations& e, std::vector<Member> members,
                              const std::vector<FreeParameter>& free) {
  Eigen::VectorXd step = Eigen::VectorXd::Zero(e.b.size());
  std::vector<Eigen::Index> open(free.size()), held;
  std::iota(open.begin(), open.end(), 0);
  while (!open.empty()) {
    const Eigen::VectorXd b = e.b(open) - e.G(open, held) * step(held);
    step(open) = solve(e.G(open, open), b);
    const size_t before = held.size();
    for (const Eigen::Index i : std::vector(open)) {
      const FreeParameter& p = free[size_t(i)];
      const auto [low, high] = reach_of(members, p);
      const double value = value_of(members, p), inside = std::clamp(value + step[i], low, high);
      if (inside == value + step[i]) continue;
      step[i] = inside - value, held.push_back(i), std::erase(open, i);
    }
    if (held.size() == before) break;
  }
  return step;
}

/// The members after a part of a step.
std::vector<Member> moved(std::vector<Member> members, const std::vector<FreeParameter>& free,
                          const Eigen::VectorXd& step, double fraction) {
  for (size_t i = 0; i < free.size(); ++i) {
    const CandidateParameter& range = range_of(members, free[i]);
    const double value = value_of(members, free[i]) + fraction * step[Eigen::Index(i)];
    set_value(members, free[i], std::clamp(value, range.low, range.high));
  }
  return members;
}

Estimate evaluated(Trials& trials, std::vector<Member> members, const Noise& noise, const Motion& motion) {
  Estimate estimate;
  estimate.members = std::move(members), estimate.noise = noise, estimate.motion = motion;
  estimate.fitted = trials.remembered->run(trials, estimate.members, motion, noise);
  estimate.mean_square = mean_square(trials, *estimate.fitted);
  estimate.profile = profile(trials, *estimate.fitted);
  estimate.against_at_rest = against_at_rest(trials, estimate.members, *estimate.fitted, noise);
  estimate.is_valid =
      std::isfinite(estimate.mean_square) && std::ranges::all_of(estimate.members, [](const Member& m) {
        return !m.candidate->is_plausible || m.candidate->is_plausible(m);
      });
  return estimate;
}

/// Of the rows that count before the hold-out, the first or the second half.
void keep_half(Trial& trial, int half) {
  const auto end = trial.usable.begin() + std::ptrdiff_t(trial.held_out_from);
  const auto rows = std::count_if(trial.usable.begin(), end, [](char counts) { return counts != 0; });
  std::ptrdiff_t seen = 0;
  for (auto row = trial.usable.begin(); row != end; ++row)
    if (*row && (2 * seen++ >= rows) != (half == 1)) *row = 0;
}

/// The motion that an estimate predicted replaces the one on which it ran, unless it explains the record
/// worse with it: along its own wrong velocity, friction of the wrong sign confirms itself.
void take_own_motion(Trials& trials, Estimate& estimate, double far) {
  Estimate own = on_own_motion(trials, estimate);
  if (own.is_valid && own.profile <= estimate.profile + far)
    estimate = std::move(own);
  else
    estimate.motion.profile = estimate.profile;
}

/// A load on a spring is moved along the motion that an estimate without it predicted. What was wrong there
/// at the start of the record swings on in the load, and bends its frequency and its damping.
bool has_load_on_a_spring(const Estimate& estimate) {
  return std::ranges::any_of(*estimate.fitted,
                             [](const Fitted& f) { return f.axis.load_states > 0 && !f.flying; });
}

}  // namespace

Estimate on_own_motion(Trials& trials, Estimate estimate) {
  Motion motion{{}, estimate.profile};
  for (const Fitted& fitted : *estimate.fitted)
    motion.paths.emplace_back(estimate.fitted, &fitted.prediction.path);
  return evaluated(trials, std::move(estimate.members), estimate.noise, motion);
}

Estimate with_own_motion(Trials& trials, Estimate estimate, int iterations) {
  constexpr int most_rounds = 3;
  for (int round = 0; round < most_rounds && estimate.is_valid; ++round) {
    Estimate own = on_own_motion(trials, estimate);
    own = fit_members(trials, std::move(own.members), estimate.noise, own.motion, iterations);
    if (!own.is_valid || !(own.profile < estimate.profile - criteria::least_gain_of_own_motion)) break;
    estimate = std::move(own);
  }
  return estimate;
}

Estimate fit_members(Trials& trials, std::vector<Member> members, const Noise& noise, const Motion& motion,
                     int iterations, double worst) {
  constexpr int iterations_beyond_limit = 2;  // of what follows a search that took too long
  if (trials.work->is_spent(1)) iterations = std::min(iterations, iterations_beyond_limit);
  Estimate best = evaluated(trials, std::move(members), noise, motion);
  const std::vector<FreeParameter> free = free_parameters(best.members);
  const double far = same_motion * double(fitted_numbers(trials));
  for (int i = 0; i < iterations && best.is_valid && !free.empty(); ++i) {
    const NormalEquations equations = normal_equations(trials, best);
    const Eigen::VectorXd step = step_in_range(equations, best.members, free);
    const double promised = step.dot(equations.b) / best.mean_square;
    if (promised < criteria::least_step_gain || best.profile - double(iterations - i) * promised > worst)
      break;
    const double before = best.profile;
    double fraction = 1;
    for (int shorter = 0; shorter < 4 && best.profile == before; ++shorter, fraction *= 0.35) {
      Estimate next = evaluated(trials, moved(best.members, free, step, fraction), noise, best.motion);
      if (next.is_valid && next.profile < before) best = std::move(next);
    }
    if (!(best.profile < before - criteria::least_step_gain)) break;
    if (std::abs(best.profile - best.motion.profile) > far) take_own_motion(trials, best, far);
  }
  return best;
}

Estimate with_own_noise(Trials& trials, Estimate estimate, int iterations, double worst) {
  const int rounds = trials.work->is_spent(1) ? 1 : 2;
  for (int round = 0; round < rounds && estimate.is_valid; ++round) {
    const double before = estimate.profile;
    const Noise noise = fit_noise_alone(trials, *estimate.fitted, estimate.noise, FreeNoise::all);
    estimate = evaluated(trials, std::move(estimate.members), noise, estimate.motion);
    if (estimate.profile > std::max(before, worst)) break;  // what is left is no noise: see fit_noise_alone()
    estimate = fit_members(trials, std::move(estimate.members), noise, estimate.motion, iterations, worst);
    if (estimate.is_valid && has_load_on_a_spring(estimate))
      estimate = with_own_motion(trials, std::move(estimate), iterations);
    const double gained = std::max(before - estimate.profile, 0.0);
    if (estimate.profile - gained > worst) break;
  }
  return estimate;
}

Estimate snap_to_turn(Trials& trials, Estimate estimate) {
  const double span = trials.highest_position - trials.lowest_position;
  for (size_t m = 0; trials.turn > 0 && m < estimate.members.size(); ++m) {
    const Candidate& candidate = *estimate.members[m].candidate;
    if (!candidate.is_periodic || candidate.repeats_in_time || estimate.members[m].is_part_of_turn) continue;
    const double pitch = estimate.members[m].nonlinear[0];
    const double times = std::round(trials.turn / pitch);
    if (times < 1 || std::abs(span / pitch - span * times / trials.turn) > criteria::most_drift) continue;
    std::vector<Member> members = estimate.members;
    members[m].nonlinear[0] = trials.turn / times, members[m].is_part_of_turn = true;
    Estimate snapped = fit_members(trials, std::move(members), estimate.noise, estimate.motion, 3);
    const double most_loss =
        std::max(criteria::least_gain, criteria::least_gain_per_row * double(fitted_numbers(trials)));
    // On less than a turn the next whole number is about as close.
    const bool is_whole_turn = span >= criteria::nearly_a_turn * trials.turn;
    if (snapped.is_valid && (is_whole_turn || snapped.profile - estimate.profile <= most_loss))
      estimate = std::move(snapped);
  }
  return estimate;
}

void widen_by_blocks(const Trials& trials, Estimate& estimate) {
  const Eigen::Index n = estimate.covariance.rows();
  if (n == 0) return;
  const size_t ports = trials.ports();
  Eigen::MatrixXd between = Eigen::MatrixXd::Zero(n, n), within = between;  // of blocks, of rows
  const auto sensitivities =
      trials.remembered->sensitivities(trials, estimate.members, estimate.motion, estimate.fitted);
  for (size_t t = 0; t < trials.list.size(); ++t) {
    const Trial& trial = trials.list[t];
    const Fitted& fitted = (*estimate.fitted)[t];
    const Path& path = *estimate.motion.paths[t];
    const Sensitivity& s = (*sensitivities)[t];
    const size_t block = std::max<size_t>(1, whole_count(criteria::independent_block_s / path.sample_time));
    Eigen::MatrixXd scores(Eigen::Index(block), n);
    for (size_t start = 0; start < trial.held_out_from; start += block) {
      const std::vector<size_t> counted = fitted_rows(trial, start, block);
      if (counted.empty()) continue;
      const auto score = [&](const std::vector<double>& column, size_t k) {
        double sum = 0;
        for (size_t p = k * ports; p < (k + 1) * ports; ++p) sum += column[p] * fitted.white[p];
        return sum;
      };
      const Eigen::Index rows = Eigen::Index(counted.size());
      for (Eigen::Index c = 0; c < n; ++c)
        for (Eigen::Index r = 0; r < rows; ++r)
          scores(r, c) = score(s.columns[size_t(c)], counted[size_t(r)]);
      const Eigen::VectorXd sum = scores.topRows(rows).colwise().sum();
      within.noalias() += scores.topRows(rows).transpose() * scores.topRows(rows);
      between.noalias() += sum * sum.transpose();
    }
  }
  const Eigen::MatrixXd& C = estimate.covariance;
  const Eigen::VectorXd alike = (C * between * C).diagonal(), independent = (C * within * C).diagonal();
  const Eigen::VectorXd factor = alike.cwiseQuotient(independent.cwiseMax(1e-300)).cwiseMax(1.0).cwiseSqrt();
  estimate.covariance = factor.asDiagonal() * C * factor.asDiagonal();
}

void widen_by_halves(Trials& trials, Estimate& estimate) {
  if (std::ranges::none_of(estimate.members, is_own_load)) return;
  constexpr int iterations = 6;
  const std::vector<FreeParameter> free = free_parameters(estimate.members);
  Eigen::MatrixXd value(Eigen::Index(free.size()), 2);
  std::vector<std::vector<char>> usable;
  for (const Trial& trial : trials.list) usable.push_back(trial.usable);
  for (int half : {0, 1}) {
    for (size_t t = 0; t < usable.size(); ++t) keep_half(trials.list[t], half);
    Estimate of_half = fit_members(trials, estimate.members, estimate.noise, estimate.motion, iterations);
    for (size_t i = 0; i < free.size(); ++i)
      value(Eigen::Index(i), half) = value_of(of_half.members, free[i]);
    for (size_t t = 0; t < usable.size(); ++t) trials.list[t].usable = usable[t];
    if (!of_half.is_valid) return;
  }
  // Each of two alike halves has twice the variance of the whole, their difference four times.
  const Eigen::VectorXd deviation = estimate.covariance.diagonal().cwiseMax(1e-300).cwiseSqrt();
  const Eigen::VectorXd factor =
      ((value.col(1) - value.col(0)).cwiseAbs().cwiseQuotient(2 * deviation)).cwiseMax(1.0);
  estimate.covariance = factor.asDiagonal() * estimate.covariance * factor.asDiagonal();
}

/// From the phase at the middle of the record to that at zero, in which sine and cosine are told.
void refer_to_zero(Estimate& estimate) {
  const std::vector<FreeParameter> free = free_parameters(estimate.members);
  Eigen::MatrixXd to_zero = Eigen::MatrixXd::Identity(estimate.covariance.rows(), estimate.covariance.cols());
  for (size_t i = 0; i < free.size(); ++i) {
    const Member& member = estimate.members[free[i].member];
    if (!is_period(member, free[i])) continue;
    const double period = member.nonlinear[0], centre = member.candidate->nonlinear[0].centre;
    const double rate = -2 * std::numbers::pi * centre / (period * period);
    for (size_t j = 0; j < free.size(); ++j)
      if (free[j].member == free[i].member && free[j].is_linear)
        to_zero(Eigen::Index(j), Eigen::Index(i)) =
            free[j].index == 0 ? rate * member.linear[1] : -rate * member.linear[0];
  }
  estimate.covariance = to_zero * estimate.covariance * to_zero.transpose();
}

NormalEquations normal_equations(const Trials& trials, const Estimate& estimate,
                                 const std::vector<std::vector<double>>& errors) {
  return normal_equations_of(trials, estimate,
                             [&](size_t t) -> const std::vector<double>& { return errors[t]; });
}

void work_out_covariance(Trials& trials, Estimate& estimate) {
  const std::vector<FreeParameter> free = free_parameters(estimate.members);
  if (free.empty()) return;
  const NormalEquations e = normal_equations(trials, estimate);
  // A level that no row reaches is completely unknown, but must be a finite number.
  const auto inverse_root = [](double squares) { return squares > 0 ? 1 / std::sqrt(squares) : 1.0; };
  const Eigen::VectorXd scale = e.G.diagonal().unaryExpr(inverse_root);
  Eigen::MatrixXd scaled = scale.asDiagonal() * e.G * scale.asDiagonal();
  scaled.diagonal().array() += 1e-12;
  estimate.covariance = scale.asDiagonal() * scaled.inverse() * scale.asDiagonal();
  estimate.covariance *= std::max(1.0, estimate.mean_square);
}

}  // namespace loopwright::diagnosis
