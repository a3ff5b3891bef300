/// The axis linearized by differences along the recorded motion.
#include <algorithm>
#include <cmath>
#include "engine/run/run.h"
#include "tools/diagnose/predict/axis_model.h"

namespace loopwright::diagnosis {
namespace {

/// Rows distributed over the record where the axis moves.
std::vector<size_t> operating_rows(const AxisRecord& record) {
  std::vector<size_t> rows;
  const std::vector<double>& y = record.measured.front().value;
  const bool is_velocity = record.measured.front().role == "velocity";
  double greatest = 0;
  const auto speed = [&](size_t k) {
    return is_velocity ? std::abs(y[k]) : std::abs(y[k + 1] - y[k - 1]) / (2 * record.sample_time);
  };
  for (size_t k = 1; k + 1 < y.size(); ++k) greatest = std::max(greatest, speed(k));
  const size_t step = std::max<size_t>(1, y.size() / 64);
  for (size_t k = 1; k + 1 < y.size() && rows.size() < 24; k += step)
    if (speed(k) > 0.1 * greatest) rows.push_back(k);
  if (rows.empty()) rows.push_back(std::min<size_t>(1, y.size() - 1));
  return rows;
}

/// The positions at which the diagram is linearized; those of a measured velocity begin where it begins.
std::vector<double> positions_of(const AxisRecord& record) {
  if (const MeasuredPort* position = record.find("position")) return position->value;
  const std::vector<double>& velocity = record.measured.front().value;
  std::vector<double> position(velocity.size(), record.first_position);
  for (size_t k = 1; k < position.size(); ++k) {
    const double step = record.sample_time * (record.duration.empty() ? 1 : record.duration[k - 1]);
    position[k] = position[k - 1] + step * (velocity[k - 1] + velocity[k]) / 2;
  }
  return position;
}

/// Whether values scatter by more than their mean. Of cogging, the mean of a few is a fifth of their scatter.
bool scatter_about_zero(const std::vector<double>& values) {
  const double n = double(values.size());
  double mean = 0, square = 0;
  for (double v : values) mean += v / n;
  for (double v : values) square += (v - mean) * (v - mean) / n;
  return std::abs(mean) <= std::sqrt(square);
}

/// In a map each row is independent: one state, the remaining sum of the model's forces, which is measured to
/// be zero.
LinearAxis balance_of(const LinearAxis& moving, double force_per_input) {
  LinearAxis linear;
  linear.inertia = moving.inertia, linear.damping = moving.damping;
  linear.A = Eigen::MatrixXd::Zero(1, 1), linear.C = Eigen::MatrixXd::Ones(1, 1);
  linear.push = Eigen::VectorXd::Ones(1);
  linear.input_push = Eigen::VectorXd::Constant(1, force_per_input);
  linear.slope_share = Eigen::VectorXd::Zero(1), linear.noise_push = linear.push;
  return linear;
}

/// See LinearAxis::slope_share. Of v' = (f - D v) / M with z = D T / M and f = τ/T - ½, in units of what f =
/// 1 does: the velocity is ½ - (1 - e^(-z) (1 + z)) / (z (1 - e^(-z))), near z/12, and the position follows
/// from the balance of momentum.
struct SlopeShares {
  double position = -1.0 / 6, velocity = 0;
};
SlopeShares slope_shares(double decay) {
  constexpr double least = 1e-2;  // below it the differences drown in rounding
  const double z = decay > 0 ? -std::log(decay) : 0;
  if (std::abs(z) < least) return {-(1 - z / 6) / 6, z / 12};
  const double velocity = 0.5 - (1 - decay * (1 + z)) / (z * (1 - decay));
  return {-velocity * (1 - decay) / (z - (1 - decay)), velocity};
}

/// Inertia, damping and the shares of a slope, from how a velocity decays and what a force does to it: v' =
/// (F - D v) / M, exactly. `x`: the position among the states; -1: none.
void read_law_of_motion(LinearAxis& linear, Eigen::Index v, Eigen::Index x, double sample_time) {
  const double decay = linear.A(v, v), per_force = linear.push[v];
  const SlopeShares shares = slope_shares(decay);
  linear.damping = (1 - decay) / per_force;
  const double rate = decay < 1 ? -std::log(decay) : 0;
  linear.inertia = rate > 0 ? linear.damping / (rate / sample_time) : sample_time / per_force;
  linear.slope_share[v] = shares.velocity;
  if (x >= 0) linear.slope_share[x] = shares.position;
}

}  // namespace

Eigen::VectorXd AxisModel::sample_from(const Eigen::VectorXd& states, double input, double force) {
  // States that nobody sees, sampled filters and delays are as before every trial.
  std::ranges::copy(remembered_, run_->arena().begin());
  run_->restored({plan_->clock.time(plan_->start_tick), plan_->start_tick});
  for (size_t i = 0; i < seen_.size(); ++i) numbers_[plan_->signals + seen_[i]] = states[Eigen::Index(i)];
  step_run(input, force);
  Eigen::VectorXd next(states.size());
  for (size_t i = 0; i < seen_.size(); ++i) next[Eigen::Index(i)] = state(seen_[i]);
  return next;
}

const LinearAxis& AxisModel::linearize() {
  if (!linearized_)
    linearized_ = record_.is_map ? balance_of(linearize_motion(), force_per_input_) : linearize_motion();
  return *linearized_;
}

LinearAxis AxisModel::linearize_motion() {
  const Eigen::Index n = Eigen::Index(seen_.size());
  LinearAxis linear;
  linear.A = Eigen::MatrixXd::Zero(n, n);
  linear.push = linear.input_push = Eigen::VectorXd::Zero(n);
  linear.C = Eigen::MatrixXd::Zero(Eigen::Index(record_.measured.size()), n);
  const std::vector<size_t> rows = operating_rows(record_);
  double input_size = 0, force_size = 0;
  for (double u : record_.input) input_size = std::max(input_size, std::abs(u));
  for (double f : driving_force_) force_size = std::max(force_size, std::abs(f));
  if (input_size == 0) input_size = 1;
  if (force_size == 0) force_size = 1;
  const MeasuredPort* position = record_.find("position");
  const MeasuredPort* velocity = record_.find("velocity");
  const std::vector<double> place = positions_of(record_);
  const auto place_of = [&](Number number) {  // among the states; -1: it is none
    const auto found = std::ranges::find(seen_, number - plan_->signals);
    return number < 0 || found == seen_.end() ? Eigen::Index(-1) : Eigen::Index(found - seen_.begin());
  };
  const Eigen::Index v = linear.velocity = place_of(velocity_), x = linear.position = place_of(position_);
  std::vector<double> slopes;  // of the velocity over the position
  const double weight = 1.0 / double(rows.size());
  for (size_t k : rows) {
    start(place[k],
          velocity ? velocity->value[k] : (place[k + 1] - place[k - 1]) / (2 * record_.sample_time));
    remembered_.assign(run_->arena().begin(), run_->arena().end());
    Eigen::VectorXd at(n);
    for (Eigen::Index i = 0; i < n; ++i) at[i] = state(seen_[size_t(i)]);
    const double u = record_.input[k], push = 1e-3 * force_size, change_of_u = 1e-3 * input_size;
    linear.push += weight * (sample_from(at, u, push) - sample_from(at, u, -push)) / (2 * push);
    linear.input_push += weight *
                         (sample_from(at, u + change_of_u, 0) - sample_from(at, u - change_of_u, 0)) /
                         (2 * change_of_u);
    const Eigen::VectorXd moved = sample_from(at, u, force_size) - sample_from(at, u, 0);
    for (Eigen::Index i = 0; i < n; ++i) {
      // Far from zero a smaller change would drown in rounding.
      const double change = std::max({1e-2 * std::abs(moved[i]), 1e-9, 1e-7 * std::abs(at[i])});
      Eigen::VectorXd up = at, down = at;
      up[i] += change, down[i] -= change;
      const Eigen::VectorXd high = sample_from(up, u, 0);
      const Eigen::VectorXd slope = (high - sample_from(down, u, 0)) / (2 * change);
      linear.A.col(i) += weight * slope;
      if (i == x && v >= 0) slopes.push_back(slope[v]);
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      const double change = std::max(std::abs(moved[i]), 1e-6);
      for (size_t port = 0; port < record_.measured.size(); ++port) {
        double seen[2];
        for (int side : {0, 1}) {
          for (Eigen::Index j = 0; j < n; ++j) numbers_[plan_->signals + seen_[size_t(j)]] = at[j];
          correct(seen_[size_t(i)], side ? change : -change);
          if (all_outputs_) net_force(u, 0);
          seen[side] = measured(port);
        }
        linear.C(Eigen::Index(port), i) += weight * (seen[1] - seen[0]) / (2 * change);
      }
    }
  }
  // Memories of sampled blocks are no states here: effects at the input act as in steady state.
  if (input_is_filtered_ && inner_states_.empty()) linear.input_push = linear.push * force_per_input_;
  linear.noise_push = linear.push;
  if (noise_enters_at_input_) linear.noise_push = linear.input_push / force_per_input_;
  // What rises here and falls there with a position that nobody measures, as cogging, does not show it.
  if (!position && !slopes.empty() && scatter_about_zero(slopes))
    linear.A.col(x) = Eigen::VectorXd::Unit(n, x);
  linear.slope_share = Eigen::VectorXd::Zero(n);
  if (v >= 0) read_law_of_motion(linear, v, x, record_.sample_time);
  return linear;
}

}  // namespace loopwright::diagnosis
