#include "tools/diagnose/search/whiteness.h"
#include <algorithm>
#include <cmath>
#include <numbers>
#include "models/random/philox.h"
#include "models/real/whole.h"
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/search/backward.h"

namespace loopwright::diagnosis {
namespace {

/// n Σ ρ².
double portmanteau(const LaggedProducts& products) {
  const std::vector<double>& squares = products.sum;
  double sum = 0;
  for (size_t lag = 1; lag < squares.size(); ++lag) sum += squares[lag] * squares[lag];
  return squares[0] > 0 ? products.rows * sum / (squares[0] * squares[0]) : 0;
}

/// A normal random number; the same for the same row.
double normal(size_t record, size_t row) {
  const UniformPair u = uniform_pair(1, record, row);
  return std::sqrt(-2 * std::log(u.first)) * std::cos(2 * std::numbers::pi * u.second);
}

/// The measured quantity as all rows of the record tell it, of the first port: the prediction, corrected by
/// what later errors say about it (fixed-interval smoother, de Jong 1989). The predictor alone follows coarse
/// counts from step to step, and would not find them again.
std::vector<double> smoothed(const Fitted& fitted, const MeasuredPort& sensor, size_t ports) {
  const ErrorSystem system(fitted, false);
  const Eigen::MatrixXd covariance = (fitted.gains.whiten.transpose() * fitted.gains.whiten).inverse();
  const Eigen::VectorXd per_error = (fitted.gains.K * covariance).col(0);
  std::vector<double> motion(fitted.prediction.path.samples());
  run_backward(
      system, fitted, [](size_t) { return true; },
      [&](size_t k, const auto&, const auto& before, const auto&, const auto&) {
        motion[k] = sensor.value[k] - fitted.prediction.error[k * ports] + per_error.dot(before);
      });
  return motion;
}

}  // namespace

LaggedProducts lagged_products(const Trials& trials, const std::vector<Fitted>& fitted, size_t port,
                               size_t together) {
  const size_t lags = criteria::portmanteau_lags;
  LaggedProducts products{std::vector<double>(lags + 1)};
  std::vector<double> error;
  std::vector<char> counts;
  for (size_t t = 0; t < trials.list.size(); ++t) {
    const Trial& trial = trials.list[t];
    error.clear(), counts.clear();
    for (size_t k = 0; k + together <= trial.held_out_from; k += together) {
      double sum = 0;
      bool all = true;
      for (size_t i = k; i < k + together; ++i)
        sum += fitted[t].white[i * trials.ports() + port], all &= trial.usable[i] != 0;
      error.push_back(sum), counts.push_back(all);
    }
    for (size_t k = 0; k < error.size(); ++k) {
      if (!counts[k]) continue;
      products.rows += 1;
      for (size_t lag = 0; lag <= std::min(lags, k); ++lag)
        if (counts[k - lag]) products.sum[lag] += error[k] * error[k - lag];
    }
  }
  return products;
}

size_t rows_in_a_lag(const Trials& trials) {
  const double sample_time = trials.list.front().model->record().sample_time;
  return std::max<size_t>(1, whole_count(std::round(criteria::portmanteau_lag_s / sample_time)));
}

double portmanteau(const Trials& trials, const std::vector<Fitted>& fitted) {
  double most = 0;
  for (size_t port = 0; port < trials.ports(); ++port)
    for (const size_t rows : {size_t(1), rows_in_a_lag(trials)})
      most = std::max(most, portmanteau(lagged_products(trials, fitted, port, rows)));
  return most;
}

double portmanteau_of_counts(const Trials& trials, const Estimate& estimate) {
  std::vector<Fitted> feigned(trials.list.size());
  for (size_t t = 0; t < feigned.size(); ++t) {
    const MeasuredPort& sensor = trials.list[t].model->record().measured.front();
    if (!(sensor.resolution > 0) || trials.has_map()) return 0;
    const Fitted& fitted = (*estimate.fitted)[t];
    const Path& path = fitted.prediction.path;
    const std::vector<double> motion = smoothed(fitted, sensor, trials.ports());
    const double other = std::sqrt(
        std::max(0.0, std::pow(estimate.noise.measurement[0], 2) - std::pow(sensor.resolution, 2) / 12));
    std::vector<float> error(motion.size());
    for (size_t k = 0; k < error.size(); ++k) {
      const double seen = motion[k] + other * normal(2 * t, k);
      error[k] = float(std::round(seen / sensor.resolution) * sensor.resolution - motion[k]);
    }
    const Column counted(std::move(error));
    const Column* const one = &counted;
    std::vector<double>& white = feigned[t].white;
    white = responses(fitted.axis, fitted.gains, path, Acts::sensor, {&one, 1}).front();
    double square = 0;
    for (double e : white) square += e * e / double(white.size());
    for (size_t k = 0; k < white.size(); ++k)
      white[k] += std::sqrt(std::max(0.0, 1 - square)) * normal(2 * t + 1, k);
  }
  return std::max(0.0, portmanteau(trials, feigned) - double(criteria::portmanteau_lags));
}

}  // namespace loopwright::diagnosis
