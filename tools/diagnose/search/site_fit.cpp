#include "tools/diagnose/search/site_fit.h"
#include <nlopt.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include "tools/diagnose/criteria.h"

namespace loopwright::diagnosis {
namespace {

/// [s] Of the longest record among the first rows.
double longest_duration(const SignalRecord& record, size_t rows) {
  double longest = 0, duration = 0;
  for (size_t row = 0; row < rows; ++row) {
    if (record.begins_at(row)) duration = 0;
    longest = std::max(longest, duration += record.step(row));
  }
  return longest;
}

/// A parameter keeps its sign and its order of magnitude: beyond, the diagram is another one.
constexpr double widest_factor = 50;
/// Lengths of a Gauss-Newton step that are tried where a whole one does not help.
constexpr double shorter_steps[] = {0.4, 0.1, 0.02};
/// [of the decrease that linear errors would have] A step that reaches it finds nearly the same derivatives
/// at its end: they cost a run of the model for every number.
constexpr double still_linear = 0.8;
/// [in -2 ln L] Smaller improvements end a refinement.
constexpr double enough = 0.05;
constexpr double infinite = std::numeric_limits<double>::infinity();

/// The numbers of a noise that are fitted.
std::vector<double*> fitted_numbers(SiteNoise& noise) {
  std::vector<double*> list;
  const auto add = [&](std::vector<double>& values) {
    for (double& value : values) list.push_back(&value);
  };
  if (!noise.is_of_simulation) add(noise.process);
  add(noise.measurement);
  for (SlowNoise& slow : noise.slow) list.push_back(&slow.size), list.push_back(&slow.time);
  return list;
}

}  // namespace

std::vector<FittedNumber> fitted_numbers(const SiteHypothesis& h) {
  using enum FittedNumber::Kind;
  std::vector<FittedNumber> list;
  for (size_t i = 0; i < h.is_free.size(); ++i)
    if (h.is_free[i]) list.push_back({factor, int(i)});
  for (size_t t = 0; t < h.terms.size(); ++t) {
    const TermShape& shape = *h.terms[t].shape;
    if (shape.has_coefficients())
      for (int c = 0; c < shape.columns; ++c) list.push_back({coefficient, int(t), c});
    for (int p = 0; p < shape.nonlinear_count(); ++p) list.push_back({nonlinear, int(t), p});
  }
  return list;
}

double& value_of(SiteHypothesis& h, const FittedNumber& number) {
  switch (number.kind) {
    case FittedNumber::Kind::factor:
      return h.factors[size_t(number.owner)];
    case FittedNumber::Kind::coefficient:
      return h.terms[size_t(number.owner)].coefficient[size_t(number.index)];
    default:
      return h.terms[size_t(number.owner)].nonlinear[size_t(number.index)];
  }
}

size_t size_of(const SiteHypothesis& h) { return fitted_numbers(h).size(); }

SiteFitter::SiteFitter(SiteFilter& filter, size_t rows, std::function<bool()> is_interrupted)
    : filter_(filter),
      rows_(rows),
      longest_slow_time_(criteria::longest_slow_part * longest_duration(filter.model().record(), rows)),
      is_interrupted_(std::move(is_interrupted)),
      errors_(rows * filter.model().record().outputs.size()) {}

void SiteFitter::use(const SiteHypothesis& h) { model().use(h.factors, h.terms); }

bool SiteFitter::pass(SiteHypothesis& h, bool with_columns, SitePass& to) {
  use(h);
  const bool good = filter_.run(rows_, h.noise, with_columns, to);
  h.objective = good ? to.objective() : infinite;
  h.scaled_objective = good ? to.scaled_objective() : infinite;
  return good;
}

Eigen::VectorXd SiteFitter::whitened(const SitePass& pass) const {
  Eigen::VectorXd e(Eigen::Index(pass.error.size()));
  for (size_t i = 0; i < pass.error.size(); ++i)
    e[Eigen::Index(i)] = std::isnan(pass.error[i]) ? 0 : pass.error[i] / std::sqrt(pass.variance[i]);
  return e;
}

double SiteFitter::scaled_objective_beside(const SiteHypothesis& h, const SitePass& about) {
  use(h);
  if (!filter_.run_frozen(about, errors_)) return infinite;
  double squares = 0;
  for (size_t k = 0; k < errors_.size(); ++k)
    if (!std::isnan(about.error[k])) squares += squared(errors_[k]) / about.variance[k];
  const double count = double(about.readings);
  return std::isfinite(squares) ? about.log_variances + count * std::log(squares / count) + count : infinite;
}

double SiteFitter::step_of(const SiteHypothesis& h, const FittedNumber& number) const {
  if (number.kind == FittedNumber::Kind::factor) return 1e-5 * h.factors[size_t(number.owner)];
  const SiteTerm& term = h.terms[size_t(number.owner)];
  if (number.kind == FittedNumber::Kind::coefficient) return 1e-3 * term.unit[size_t(number.index)];
  return 1e-4 * (term.high[size_t(number.index)] - term.low[size_t(number.index)]);
}

Eigen::MatrixXd SiteFitter::jacobian(const SiteHypothesis& h, const SitePass& about) {
  const std::vector<FittedNumber> numbers = fitted_numbers(h);
  Eigen::MatrixXd J(Eigen::Index(about.error.size()), Eigen::Index(numbers.size()));
  SiteHypothesis moved = h;
  const auto is_run_at = [&](size_t i, double step) {
    double& value = value_of(moved, numbers[i]);
    const double before = value;
    value += step;
    use(moved);
    value = before;
    return filter_.run_frozen(about, errors_);
  };
  for (size_t i = 0; i < numbers.size(); ++i) {
    double step = step_of(h, numbers[i]);
    bool is_run = is_run_at(i, step);
    if (!is_run) is_run = is_run_at(i, step = -step);
    for (size_t k = 0; k < errors_.size(); ++k)
      J(Eigen::Index(k), Eigen::Index(i)) =
          !is_run || std::isnan(about.error[k])
              ? 0
              : (errors_[k] - about.error[k]) / (step * std::sqrt(about.variance[k]));
  }
  return J;
}

void SiteFitter::keep_within_limits(SiteHypothesis& h, const FittedNumber& number, double before) const {
  double& value = value_of(h, number);
  if (number.kind == FittedNumber::Kind::factor)
    value = std::clamp(std::clamp(value, before / 3, before * 3), 1 / widest_factor, widest_factor);
  if (number.kind != FittedNumber::Kind::nonlinear) return;
  const SiteTerm& term = h.terms[size_t(number.owner)];
  const double low = term.low[size_t(number.index)], high = term.high[size_t(number.index)];
  const double most = low > 0 ? std::max(before / 2, 0.01 * (high - low)) : 0.2 * (high - low);
  value = std::clamp(std::clamp(value, before - most, before + most), low, high);
}

/// One system of linear equations for a step: derivatives and what is left, whitened, with the prior as rows.
struct SiteFitter::Normal {
  Eigen::MatrixXd derivatives;  ///< of the whitened errors
  Eigen::VectorXd move;
  double decrease = 0;  ///< of the objective, as far as the errors are linear
};

void SiteFitter::solve(const SiteHypothesis& h, const std::vector<FittedNumber>& numbers,
                       Normal& normal) const {
  const double scale = std::sqrt(pass_.squares / double(pass_.readings));
  const Eigen::MatrixXd& J = normal.derivatives;
  const Eigen::Index rows = J.rows(), count = J.cols();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(rows + count, count);
  Eigen::VectorXd rest = Eigen::VectorXd::Zero(rows + count);
  all.topRows(rows) = J / scale, rest.head(rows) = -whitened(pass_) / scale;
  Eigen::VectorXd stated = Eigen::VectorXd::Zero(count);  // information of the prior
  for (Eigen::Index i = 0; i < count; ++i)
    if (numbers[size_t(i)].kind == FittedNumber::Kind::factor) {
      SiteHypothesis at = h;
      stated[i] = 1 / squared(criteria::deviation_of_stated_parameter);
      all(rows + i, i) = 1 / criteria::deviation_of_stated_parameter;
      rest[rows + i] = (1 - value_of(at, numbers[size_t(i)])) / criteria::deviation_of_stated_parameter;
    }
  Eigen::VectorXd norm = all.colwise().norm().transpose();
  for (double& size : norm)
    if (!(size > 0)) size = 1;
  const Eigen::MatrixXd unit =
      norm.cwiseInverse().asDiagonal() * (all.transpose() * all) * norm.cwiseInverse().asDiagonal();
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(unit);
  const Eigen::VectorXd right = norm.cwiseInverse().asDiagonal() * (all.transpose() * rest);
  normal.move = Eigen::VectorXd::Zero(count), normal.decrease = 0;
  for (Eigen::Index i = 0; i < count; ++i) {
    // What the record tells less about than the diagram goes to what is stated.
    const double told =  // share of the diagram
        eigen.eigenvectors().col(i).cwiseQuotient(norm).cwiseAbs2().dot(stated) / eigen.eigenvalues()[i];
    if (!(eigen.eigenvalues()[i] > criteria::weakest_direction) && !(told > 1 - told)) continue;
    const double along = eigen.eigenvectors().col(i).dot(right);
    normal.move += eigen.eigenvectors().col(i) * (along / eigen.eigenvalues()[i]);
    normal.decrease += along * along / eigen.eigenvalues()[i];
  }
  normal.move = norm.cwiseInverse().asDiagonal() * normal.move;
}

void SiteFitter::refine(SiteHypothesis& h, int steps) {
  const std::vector<FittedNumber> numbers = fitted_numbers(h);
  if (!pass(h, false, pass_) || numbers.empty()) return;
  const auto prior = [&](const SiteHypothesis& at) {
    double sum = 0;
    for (size_t i = 0; i < at.factors.size(); ++i)
      if (at.is_free[i]) sum += std::pow((at.factors[i] - 1) / criteria::deviation_of_stated_parameter, 2);
    return sum;
  };
  double best = pass_.scaled_objective() + prior(h);
  const auto is_lower_at = [&](double length, const Normal& normal) {
    SiteHypothesis trial = h;
    for (size_t i = 0; i < numbers.size(); ++i) {
      double& value = value_of(trial, numbers[i]);
      const double before = value;
      value += length * normal.move[Eigen::Index(i)];
      keep_within_limits(trial, numbers[i], before);
    }
    SitePass there;
    if (!pass(trial, false, there)) return false;
    const double objective = there.scaled_objective() + prior(trial);
    if (!(objective < best)) return false;
    best = objective, h = std::move(trial), pass_ = std::move(there);
    return true;
  };
  Normal normal;
  bool is_known = false;  // the derivatives, from an earlier step
  for (int step = 0; step < steps && !is_interrupted_(); ++step) {
    const bool is_new = !is_known;
    if (is_new) normal.derivatives = jacobian(h, pass_);
    solve(h, numbers, normal);
    if (normal.decrease < enough) return;
    const double before = best;
    is_known = is_lower_at(1, normal) && before - best > still_linear * normal.decrease;
    if (before == best && is_new)
      std::ranges::any_of(shorter_steps, [&](double length) { return is_lower_at(length, normal); });
    if (is_new && !(before - best > enough)) return;
  }
}

/// The best noise about a pass, from a first one.
SiteNoise SiteFitter::best_noise(const SitePass& pass, const SiteNoise& from) const {
  constexpr double widest = 12;        // e-fold changes within one search
  constexpr double settled = 0.002;    // [in -2 ln L] Smaller improvements end a search,
  constexpr double same_noise = 1e-3;  // [e-folds] and so do smaller steps.
  constexpr double notable = 1;        // [in -2 ln L] Larger improvements begin another.
  constexpr double far_off = 1e4;      // [in -2 ln L] What is worse, or not finite, counts as so much worse.
  constexpr int most_rounds = 6;
  const SiteNoise guess = filter_.guess_noise();
  SiteNoise noise = from;
  const std::vector<double*> numbers = fitted_numbers(noise);
  const size_t count = numbers.size();
  std::vector<double> first;
  for (const double* number : numbers) first.push_back(*number);
  const auto noise_at = [&](const std::vector<double>& at) {
    for (size_t i = 0; i < count; ++i) *numbers[i] = first[i] * std::exp(at[i]);
    for (size_t j = 0; j < noise.measurement.size(); ++j)
      noise.measurement[j] = std::max(noise.measurement[j], 1e-4 * guess.measurement[j]);
    for (SlowNoise& slow : noise.slow)
      slow.time = std::clamp(slow.time, shortest_slow_time(), longest_slow_time());
    return noise;
  };
  using Objective = std::function<double(const std::vector<double>&)>;
  double most = 1e100;
  Objective objective = [&](const std::vector<double>& at) {
    return std::min(filter_.objective_with(pass, noise_at(at)), most);
  };
  std::vector<double> best(count, 0.0);
  double reached = objective(best);
  most = reached + far_off;
  // Quadratic models follow a valley to where its curvature is another one: they are begun anew there.
  for (int round = 0; round < most_rounds && !is_interrupted_(); ++round) {
    nlopt::opt search(count > 1 ? nlopt::LN_BOBYQA : nlopt::LN_SBPLX, unsigned(count));
    search.set_min_objective([](const std::vector<double>& at, std::vector<double>&,
                                void* f) { return (*static_cast<Objective*>(f))(at); },
                             &objective);
    search.set_lower_bounds(-widest), search.set_upper_bounds(widest), search.set_initial_step(1.0);
    search.set_ftol_abs(settled), search.set_xtol_abs(same_noise), search.set_maxeval(int(40 * count));
    std::vector<double> x = best;
    double there = reached;
    try {
      search.optimize(x, there);
    } catch (const nlopt::roundoff_limited&) {  // x is the best point so far
      there = objective(x);
    }
    const double gained = reached - there;
    if (!(gained > 0)) break;
    best = x, reached = there;
    if (!(gained > notable)) break;
  }
  return noise_at(best);
}

/// With every component as large as the largest, in proportion to what it does. Nothing if none had vanished.
std::optional<SiteNoise> SiteFitter::evened(const SiteNoise& noise) const {
  constexpr double vanished = 0.02;  // [of the largest]
  SiteNoise even = noise;
  bool has_vanished = false;
  double largest = 0;
  const size_t sites = noise.is_of_simulation ? 0 : noise.sites.size();
  for (size_t s = 0; s < sites; ++s)
    largest = std::max(largest, noise.process[s] / filter_.site_scale(noise.sites[s]));
  for (size_t s = 0; s < sites; ++s) {
    const double size = largest * filter_.site_scale(noise.sites[s]);
    has_vanished |= noise.process[s] < vanished * size;
    even.process[s] = std::max(noise.process[s], size);
  }
  const SiteNoise guess = filter_.guess_noise();
  for (size_t j = 0; j < noise.measurement.size(); ++j) {
    has_vanished |= noise.measurement[j] < vanished * guess.measurement[j];
    even.measurement[j] = std::max(noise.measurement[j], 0.3 * guess.measurement[j]);
  }
  return has_vanished ? std::optional(even) : std::nullopt;
}

void SiteFitter::fit_noise(SiteHypothesis& h) {
  constexpr int rounds = 2;  // the linearization moves with the filtered path
  for (int round = 0; round < rounds && !is_interrupted_(); ++round) {
    if (!pass(h, false, pass_)) return;
    const double before = h.objective;
    SiteHypothesis trial = h;
    trial.noise = best_noise(pass_, h.noise);
    if (const auto even =
            evened(trial.noise)) {  // a component that has vanished does not come back by itself
      const SiteNoise other = best_noise(pass_, *even);
      if (filter_.objective_with(pass_, other) < filter_.objective_with(pass_, trial.noise))
        trial.noise = other;
    }
    SitePass there;
    if (!pass(trial, false, there) || !(trial.objective < before)) return;
    h = trial;
    if (before - trial.objective < 1) return;
  }
}

/// A law with a memory changes fastest where the motion turns, and needs shorter steps there than the diagram
/// by itself.
void SiteFitter::shorten_steps(SiteHypothesis& h) {
  constexpr double difference = 1e-5;  // [of the size of a state] in a sample, below a tenth of usual noise
  const auto remembers = [](const SiteTerm& term) { return term.shape->remembered != nullptr; };
  SitePass there;
  if (std::ranges::any_of(h.terms, remembers) && pass(h, false, there))
    filter_.choose_substeps(there, difference);
}

void SiteFitter::anneal(SiteHypothesis& h) {
  constexpr double colder = 5, most_colder = 1e4;
  constexpr double better = 2, same_optimum = 0.5;  // in -2 ln L
  shorten_steps(h);
  fit_noise(h);
  if (!std::isfinite(h.objective)) return;
  if (h.noise.is_of_simulation) {  // there is but one optimum
    refine(h, 6);
    fit_noise(h);
    return;
  }
  const SiteNoise guess = filter_.guess_noise();
  int failures = 0;
  double factor = colder;
  while (failures < 2 && factor < most_colder && !is_interrupted_()) {
    SiteHypothesis trial = h;
    for (double& sigma : trial.noise.process) sigma /= factor;
    for (size_t j = 0; j < trial.noise.measurement.size(); ++j)
      trial.noise.measurement[j] = std::max(trial.noise.measurement[j], 0.3 * guess.measurement[j]);
    SitePass there;
    if (!pass(trial, false, there)) break;
    const double scale = std::sqrt(there.squares / double(there.readings));
    for (double& r : trial.noise.measurement) r *= std::max(1.0, scale);
    refine(trial, 3);
    fit_noise(trial);
    if (std::abs(trial.objective - h.objective) > same_optimum) refine(trial, 3);
    if (trial.objective < h.objective - better)
      h = trial, failures = 0, factor = colder;
    else
      ++failures, factor *= colder;
  }
}

}  // namespace loopwright::diagnosis
