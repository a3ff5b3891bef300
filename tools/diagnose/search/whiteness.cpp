#include "tools/diagnose/search/whiteness.h"
#include <algorithm>
#include <cmath>
#include <numbers>
#include "models/random/philox.h"
#include "models/real/whole.h"
#include "models/statistics/portmanteau.h"
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/backward.h"

namespace loopwright::diagnosis {
namespace {

/// Normal random numbers; the same for the same row and source of noise.
std::vector<double> normal_numbers(size_t record, size_t source, size_t rows) {
  constexpr size_t most_sources = 64;
  std::vector<double> numbers(rows);
  for (size_t row = 0; row < rows; ++row) {
    const UniformPair u = uniform_pair(1, record * most_sources + source, row);
    numbers[row] = std::sqrt(-2 * std::log(u.first)) * std::cos(2 * std::numbers::pi * u.second);
  }
  return numbers;
}

/// Of every source: each port, the noise force, and the slow one. Of the first port for each reading, of
/// which a row may hold several.
std::vector<std::vector<double>> noise_of(size_t record, size_t ports, size_t rows, size_t readings) {
  std::vector<std::vector<double>> sources;
  for (size_t source = 0; source < ports + 2; ++source)
    sources.push_back(normal_numbers(record, source, source == 0 ? rows * readings : rows));
  return sources;
}

/// The measured quantity as all rows of the record tell it, of the first port: the prediction, corrected by
/// what later errors say about it (fixed-interval smoother, de Jong 1989). The predictor alone follows coarse
/// counts from step to step, and would not find them again.
std::vector<double> smoothed(const Fitted& fitted, const MeasuredPort& sensor, size_t ports) {
  const ErrorSystem system(fitted, false);
  const Eigen::Index n = system.enter.size(), p = system.C.rows();
  const auto per_error_at = [&](size_t row) -> Eigen::VectorXd {  // P Cᵀ = K S
    const Eigen::Map<const Eigen::MatrixXd> K(fitted.gains.K_at(row), n, p),
        whiten(fitted.gains.whiten_at(row), p, p);
    return (K * (whiten.transpose() * whiten).inverse()).col(0);
  };
  Eigen::VectorXd per_error = per_error_at(0);
  std::vector<double> motion(fitted.prediction.path.samples());
  run_backward(
      system, fitted, [](size_t) { return true; },
      [&](size_t k, const auto&, const auto& before, const auto&, const auto&) {
        if (fitted.gains.rows) per_error = per_error_at(k);
        motion[k] = sensor.value[k] - fitted.prediction.error[k * ports] + per_error.dot(before);
      });
  return motion;
}

/// The same predictions with noise forces that are smaller by a factor. Where counts are coarse, what they
/// add is taken for noise forces, and a motion that these shake has no beat.
Fitted with_calmer_force(const Fitted& fitted, const Noise& noise, double factor, double nominal_inertia) {
  Fitted calm = fitted;
  calm.gains =
      gains_of(fitted.axis, {factor * noise.white, factor * noise.step, noise.memory, noise.measurement},
               nominal_inertia);
  with_gains(fitted.axis, fitted.prediction, fitted.gains, calm.gains, calm.prediction.error);
  calm.white = calm.prediction.error;
  whiten(calm.white, calm.gains);
  return calm;
}

/// What is measured minus what is, at the first port: a motion counted anew, and the other noise of the
/// sensor. `dithers`: the noise comes before the counting, and covers its pattern. Of a row that stands for
/// several, each reading is counted: slow motion has them all in one count.
std::vector<double> errors_of_counting(const std::vector<double>& motion, const AxisRecord& axis,
                                       double noise, bool dithers, const std::vector<double>& random) {
  const size_t readings = axis.rows_in_one;
  const double count_of_mean = axis.measured.front().resolution, of_one = std::sqrt(double(readings)),
               count = of_one * count_of_mean,
               other = of_one * std::sqrt(std::max(0.0, noise * noise - count_of_mean * count_of_mean / 12));
  const auto motion_at = [&](size_t row, double rows_later) {
    const size_t next =
        rows_later > 0 ? std::min(row + 1, motion.size() - 1) : row - std::min<size_t>(row, 1);
    return motion[row] + std::abs(rows_later) * (motion[next] - motion[row]);
  };
  std::vector<double> error(motion.size());
  for (size_t k = 0; k < error.size(); ++k) {
    for (size_t i = 0; i < readings; ++i) {
      const double at = motion_at(k, (double(i) + 0.5) / double(readings) - 0.5),
                   shaken = other * random[k * readings + i], seen = at + (dithers ? shaken : 0.0);
      error[k] += std::round(seen / count) * count - at + (dithers ? 0.0 : shaken);
    }
    error[k] /= double(readings);
  }
  return error;
}

/// The whitened errors of the predictor for these errors of the first port and for white noise of all other
/// kinds. `scale`: of the noise forces; `random`: see noise_of().
std::vector<double> filtered(const Fitted& fitted, const Noise& noise, double scale,
                             const std::vector<double>& first_port,
                             const std::vector<std::vector<double>>& random) {
  const ErrorSystem system(fitted, false);
  const size_t ports = size_t(system.C.rows());
  std::vector<double> white(first_port.size() * ports);
  with_sizes(fitted.axis, [&]<int States, int Ports>() {
    using Sized = SizedErrorSystem<States, Ports>;
    using State = Eigen::Matrix<double, Sized::states, 1>;
    using Port = Eigen::Matrix<double, Sized::ports, 1>;
    Sized now(system);
    const Eigen::Index slow = system.enter.size() - 1, p = Eigen::Index(ports);
    State push = State::Zero(slow + 1), x = push, next(slow + 1);
    push.head(slow) = scale * noise.white * fitted.axis.noise_push;
    Port e(p);
    for (size_t k = 0; k < first_port.size(); ++k) {
      now.take_row(fitted, k);
      e.noalias() = now.C * x;
      e[0] += first_port[k];
      for (size_t port = 1; port < ports; ++port)
        e[Eigen::Index(port)] += noise.measurement[port] * random[port][k];
      Eigen::Map<Port>(&white[k * ports], p).noalias() = now.whiten * e;
      x.noalias() -= now.correct * e;
      if (fitted.prediction.path.forgets(k)) x[slow] = 0;
      next.noalias() = now.onward * x;
      x = next + push * random[ports][k];
      x[slow] += scale * noise.step * random[ports + 1][k];
    }
  });
  return white;
}

/// With noise forces that are smaller by a factor.
std::vector<double> smoothed_with(const Trials& trials, const Estimate& estimate, size_t record,
                                  double calm) {
  const AxisModel& model = *trials.list[record].model;
  const Fitted& fitted = (*estimate.fitted)[record];
  const MeasuredPort& sensor = model.record().measured.front();
  if (!(calm < 1)) return smoothed(fitted, sensor, trials.ports());
  return smoothed(with_calmer_force(fitted, estimate.noise, calm, model.nominal_inertia()), sensor,
                  trials.ports());
}

/// Of one record, see errors_of_counts().
std::vector<double> errors_of_counts_along(const Trials& trials, const Estimate& estimate, size_t record,
                                           const std::vector<double>& motion, bool dithers,
                                           const std::vector<std::vector<double>>& random) {
  const AxisModel& model = *trials.list[record].model;
  const Fitted& fitted = (*estimate.fitted)[record];
  const Noise& noise = estimate.noise;
  return filtered(fitted, noise, fitted.axis.inertia / model.nominal_inertia(),
                  errors_of_counting(motion, model.record(), noise.measurement[0], dithers, random[0]),
                  random);
}

std::vector<Fitted> feigned(const WhitenedErrors& errors) {
  std::vector<Fitted> records(errors.size());
  for (size_t t = 0; t < errors.size(); ++t) records[t].white = errors[t];
  return records;
}

}  // namespace

LaggedProducts lagged_products(const Trials& trials, const std::vector<Fitted>& fitted, size_t port,
                               size_t together) {
  const size_t lags = criteria::portmanteau_lags;
  LaggedProducts products{std::vector<double>(lags + 1)};
  std::vector<double> pairs(lags + 1), error, counts;  // both zero where a row does not count
  const auto add_products = [lags](const std::vector<double>& of, std::vector<double>& sum) {
    const std::vector<double> more = lagged_products_of(of, lags);
    for (size_t lag = 0; lag <= lags; ++lag) sum[lag] += more[lag];
  };
  for (size_t t = 0; t < trials.list.size(); ++t) {
    const Trial& trial = trials.list[t];
    error.clear(), counts.clear();
    for (size_t k = 0; k + together <= trial.held_out_from; k += together) {
      double sum = 0;
      bool all = true;
      for (size_t i = k; i < k + together; ++i)
        sum += fitted[t].white[i * trials.ports() + port], all &= trial.usable[i] != 0;
      error.push_back(all ? sum : 0), counts.push_back(all ? 1 : 0);
    }
    add_products(error, products.sum), add_products(counts, pairs);
  }
  products.rows = pairs[0];
  for (size_t lag = 1; lag <= lags; ++lag)
    if (pairs[lag] > 0) products.sum[lag] *= std::sqrt(products.rows / pairs[lag]);
  return products;
}

size_t rows_in_a_lag(const Trials& trials) {
  const double sample_time = trials.list.front().model->record().sample_time;
  return std::max<size_t>(1, whole_count(std::round(criteria::portmanteau_lag_s / sample_time)));
}

double portmanteau(const Trials& trials, const std::vector<Fitted>& fitted) {
  double most = 0;
  for (size_t port = 0; port < trials.ports(); ++port)
    for (const size_t rows : {size_t(1), rows_in_a_lag(trials)}) {
      const LaggedProducts products = lagged_products(trials, fitted, port, rows);
      most = std::max(most, loopwright::portmanteau(products.sum, products.rows));
    }
  return most;
}

bool seems_explained(const Trials& trials, const Estimate& estimate) {
  return estimate.is_valid && estimate.mean_square < criteria::well_explained &&
         portmanteau(trials, *estimate.fitted) <= criteria::most_portmanteau_of_search;
}

double portmanteau_of_squares(const Trials& trials, const std::vector<Fitted>& fitted) {
  constexpr double largest = 3;  // [standard deviations] a single outlier is no burst
  std::vector<Fitted> squares(fitted.size());
  double sum = 0, n = 0;
  for (size_t t = 0; t < fitted.size(); ++t) {
    const Trial& trial = trials.list[t];
    squares[t].white = fitted[t].white;
    for (double& e : squares[t].white) e = std::min(e * e, largest * largest);
    for (size_t k = 0; k < trial.held_out_from; ++k)
      for (size_t p = k * trials.ports(); trial.usable[k] && p < (k + 1) * trials.ports(); ++p)
        sum += squares[t].white[p], ++n;
  }
  for (Fitted& record : squares)
    for (double& e : record.white) e -= sum / std::max(1.0, n);
  return portmanteau(trials, squares);
}

WhitenedErrors errors_of_counts(const Trials& trials, const Estimate& estimate) {
  WhitenedErrors most;
  for (const Trial& trial : trials.list)
    if (!(trial.model->record().measured.front().resolution > 0) || trials.has_map()) return {};
  std::vector<std::vector<std::vector<double>>> random;
  for (size_t t = 0; t < trials.list.size(); ++t)
    random.push_back(noise_of(t, trials.ports(), (*estimate.fitted)[t].prediction.path.samples(),
                              trials.list[t].model->record().rows_in_one));
  for (const double calm : {1.0, criteria::calmer_force}) {
    std::vector<std::vector<double>> motion;
    for (size_t t = 0; t < trials.list.size(); ++t)
      motion.push_back(smoothed_with(trials, estimate, t, calm));
    for (const bool dithers : {true, false}) {
      WhitenedErrors errors;
      for (size_t t = 0; t < trials.list.size(); ++t)
        errors.push_back(errors_of_counts_along(trials, estimate, t, motion[t], dithers, random[t]));
      if (most.empty() || portmanteau_of_counts(trials, errors) > portmanteau_of_counts(trials, most))
        most = std::move(errors);
    }
  }
  return most;
}

double portmanteau_of_counts(const Trials& trials, const WhitenedErrors& errors) {
  if (errors.empty()) return 0;
  return std::max(0.0, portmanteau(trials, feigned(errors)) - double(criteria::portmanteau_lags));
}

double bursts_of_counts(const Trials& trials, const WhitenedErrors& errors) {
  return errors.empty() ? 0 : portmanteau_of_squares(trials, feigned(errors));
}

}  // namespace loopwright::diagnosis
