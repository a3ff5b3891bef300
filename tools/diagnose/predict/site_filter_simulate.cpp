/// The model along a record without any correction.
#include <algorithm>
#include <cmath>
#include <limits>
#include "tools/diagnose/predict/site_filter.h"

namespace loopwright::diagnosis {
namespace {

using ConstMap = Eigen::Map<const Eigen::VectorXd>;

/// One over the spread of each output, so that outputs of different units count alike.
std::vector<double> weights_of(const SignalRecord& record, size_t from, size_t to) {
  std::vector<double> weights;
  for (const RecordedOutput& output : record.outputs) {
    double sum = 0, square = 0, count = 0;
    for (size_t row = from; row < to; ++row)
      if (const double y = output.value[row]; std::isfinite(y)) sum += y, square += y * y, ++count;
    const double variance = count > 0 ? square / count - sum * sum / (count * count) : 0;
    weights.push_back(variance > 0 ? 1 / std::sqrt(variance) : 1);
  }
  return weights;
}

/// Row by row; a missing reading counts as no error.
Eigen::VectorXd weighted(std::span<const double> error, const std::vector<double>& weights) {
  Eigen::VectorXd v(Eigen::Index(error.size()));
  for (size_t i = 0; i < error.size(); ++i)
    v[Eigen::Index(i)] = std::isnan(error[i]) ? 0 : error[i] * weights[i % weights.size()];
  return v;
}

}  // namespace

double SiteFilter::notable_size(const double* G) const {
  double size = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < model_states_; ++i)
    if (const double g = std::abs(G[i]); g > 0) size = std::min(size, 0.01 * state_scale_[i] / g);
  return size;
}

double SiteFilter::deviation_at(const SitePass& pass, size_t row, const SiteNoise& noise,
                                size_t index) const {
  if (!noise.is_of_simulation) return noise.process[index];
  const auto site = size_t(noise.sites[index]);
  const double size = notable_size(&pass.G[(row * pass.sites + site) * pass.states]),
               longer = record_.step(row) / record_.sample_time;
  return std::isfinite(size) ? noise.process[index] * longer * size / site_scale_[site] : 0;
}

bool SiteFilter::simulate(const SitePass& pass, const std::vector<bool>& settles, size_t from, size_t to,
                          std::span<double> error) {
  for (size_t row = from; row < to; ++row) {
    if (settles[row]) {
      std::fill_n(&error[(row - from) * pass.outputs], pass.outputs,
                  std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    if (row == from || settles[row - 1] || record_.begins_at(row)) {
      x_ = ConstMap(&pass.filtered[row * pass.states], Eigen::Index(pass.states));
      model_.put_modes_back(row, &pass.modes[row * model_.mode_bytes()]);
    }
    if (!model_.outputs(row, x_.data(), y_.data())) return false;
    for (size_t j = 0; j < pass.outputs; ++j)
      error[(row - from) * pass.outputs + j] = record_.outputs[j].value[row] - y_[j];
    if (!model_.flow(row, x_.data(), next_.data())) return false;
    x_ = next_;
  }
  return true;
}

void SiteFilter::expect_of_simulations(const SitePass& pass, const std::vector<bool>& settles, size_t from,
                                       size_t length, std::span<double> variance) {
  const auto n = Eigen::Index(pass.states);
  Eigen::MatrixXd simulated(n, n);  // covariance of the states without corrections; P_ is that with them
  for (size_t row = 0; row < pass.rows; ++row) {
    if (record_.begins_at(row)) begin_covariance(pass.noise);
    for (size_t j = 0; j < pass.outputs; ++j) {
      const size_t at = row * pass.outputs + j;
      gain_.noalias() = P_ * ConstMap(&pass.C[at * pass.states], n);
      P_.noalias() -= gain_ * ConstMap(&pass.gain[at * pass.states], n).transpose();
    }
    if (row >= from) {
      if ((row - from) % length == 0 || settles[row] || record_.begins_at(row)) {
        simulated = P_;  // what is slow is simulated as zero: its error is itself
        const auto slow = Eigen::Index(pass.noise.slow.size());
        simulated.bottomRightCorner(slow, slow).setZero();
        for (Eigen::Index j = 0; j < slow; ++j)
          simulated(n - slow + j, n - slow + j) = squared(pass.noise.slow[size_t(j)].size);
      }
      for (size_t j = 0; j < pass.outputs; ++j) {
        const ConstMap C(&pass.C[(row * pass.outputs + j) * pass.states], n);
        variance[(row - from) * pass.outputs + j] = C.dot(simulated * C) + squared(pass.noise.measurement[j]);
      }
      P_.swap(simulated), predict_covariance(pass, row, pass.noise), P_.swap(simulated);
    }
    predict_covariance(pass, row, pass.noise);
  }
}

bool SiteFilter::simulate_from(const Eigen::VectorXd& initial, size_t from, size_t to,
                               std::span<double> error) {
  model_.put_modes_back(from, start_modes_.data());
  x_ = initial, next_.resize(initial.size());
  const size_t outputs = record_.outputs.size();
  for (size_t row = from; row < to; ++row) {
    if (!model_.outputs(row, x_.data(), y_.data())) return false;
    for (size_t j = 0; j < outputs; ++j) {
      double& e = error[(row - from) * outputs + j];
      e = record_.outputs[j].value[row] - y_[j];
      if (std::isinf(e)) return false;
    }
    if (!model_.flow(row, x_.data(), next_.data())) return false;
    x_ = next_;
  }
  return true;
}

bool SiteFilter::simulate_freely(size_t from, size_t to, std::span<double> error) {
  constexpr int most_steps = 8;
  constexpr double enough = 1e-4;  // [of the squares] Smaller improvements end it.
  constexpr double weakest_direction = 1e-6;
  const std::vector<double> weights = weights_of(record_, from, to), begin = initial_states(from);
  const Eigen::Map<const Eigen::VectorXd> scale(state_scale_.data(), Eigen::Index(state_scale_.size()));
  Eigen::VectorXd best = ConstMap(begin.data(), Eigen::Index(begin.size()));
  std::vector<double> trial(error.size());
  if (!simulate_from(best, from, to, error)) return false;
  for (int step = 0; step < most_steps; ++step) {
    const Eigen::VectorXd rest = weighted(error, weights);
    Eigen::MatrixXd J(rest.size(), best.size());
    for (Eigen::Index i = 0; i < best.size(); ++i) {  // for a change by the size of the state
      Eigen::VectorXd moved = best;
      double change = difference_step;
      moved[i] += change * scale[i];
      if (!simulate_from(moved, from, to, trial)) {  // an empty tank is left on one side only
        change = -change, moved[i] = best[i] + change * scale[i];
        if (!simulate_from(moved, from, to, trial)) return true;
      }
      J.col(i) = (weighted(trial, weights) - rest) / change;
    }
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(weakest_direction);
    const Eigen::VectorXd move = solver.compute(J).solve(-rest);
    bool is_better = false;
    for (double length : {1.0, 0.3, 0.1}) {
      const Eigen::VectorXd moved = best + length * move.cwiseProduct(scale);
      if (!simulate_from(moved, from, to, trial)) continue;
      const double before = rest.squaredNorm(), after = weighted(trial, weights).squaredNorm();
      if (!(after < before)) continue;
      is_better = after < (1 - enough) * before;
      best = moved, std::ranges::copy(trial, error.begin());
      break;
    }
    if (!is_better) break;
  }
  return true;
}

}  // namespace loopwright::diagnosis
