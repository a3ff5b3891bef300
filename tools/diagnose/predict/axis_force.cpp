/// The forces on the axis along a motion, and the force produced by the input.
#include <algorithm>
#include <cmath>
#include "engine/run/run.h"
#include "tools/compare/machine.h"
#include "tools/diagnose/predict/axis_model.h"

namespace loopwright::diagnosis {
namespace {

/// For sampled filters between input and force, in a map of balances.
constexpr int samples_to_settle = 500;

/// Blocks that the input reaches without passing through the blocks of the motion.
std::vector<bool> blocks_ahead_of(const Plan& plan, Number input, const std::vector<int>& beyond) {
  std::vector<bool> reached(plan.blocks.size(), false);
  const auto reads_it = [&](size_t block) {
    return std::ranges::any_of(plan.blocks[block].inputs, [&](const auto& port) {
      return std::ranges::any_of(port, [&](Number n) {
        const int source = n < 0 ? -1 : plan.source_of(n).first;
        return n == input || (source >= 0 && reached[size_t(source)]);
      });
    });
  };
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t b = 0; b < plan.blocks.size(); ++b) {
      if (reached[b] || std::ranges::find(beyond, int(b)) != beyond.end() || !reads_it(b)) continue;
      reached[b] = changed = true;
    }
  }
  return reached;
}

bool remembers_samples(const Plan::Block& block) { return block.period > 0 || !block.buffer_lengths.empty(); }

}  // namespace

/// The states and memories on which the net force depends, apart from the motion's own.
void AxisModel::look_between_input_and_force() {
  constexpr int own_states = 2;  // of a mass: position and velocity
  std::vector<int> motion;
  for (size_t b = 0; b < plan_->blocks.size(); ++b) {
    const Plan::Block& block = plan_->blocks[b];
    const auto holds = [&](Number n) {
      const int state = n - plan_->signals;
      return state >= block.first_state && state < block.first_state + block.states;
    };
    if (!holds(position_) && !holds(velocity_)) continue;
    motion.push_back(int(b));
    force_remembers_ |= block.states > own_states;  // a load on a spring follows the axis
  }
  const std::vector<bool> behind = blocks_behind(*plan_, {force_}, motion);
  const std::vector<bool> ahead = blocks_ahead_of(*plan_, input_, motion);
  for (size_t b = 0; b < plan_->blocks.size(); ++b) {
    const Plan::Block& block = plan_->blocks[b];
    if (!behind[b]) continue;
    force_remembers_ |= block.states > 0 || remembers_samples(block);
    if (!ahead[b]) continue;
    input_is_filtered_ |= block.states > 0 || remembers_samples(block);
    for (int i = 0; i < block.states; ++i) inner_states_.push_back(block.first_state + i);
  }
}

double AxisModel::net_force(double input, double force) {
  numbers_[input_] = input;
  numbers_[injected_] = force;
  run_->evaluate(run_->due(), true);
  return numbers_[force_];
}

/// Sampled blocks keep their outputs.
double AxisModel::held_force(double input, double push) {
  numbers_[input_] = input;
  numbers_[injected_] = push;
  run_->evaluate(0, true);
  return numbers_[force_] - push;
}

double AxisModel::net_force_along(double position, double velocity, double input, double force) {
  place(position, velocity);
  const double net = net_force(input, force);
  run_->accept();
  return net;
}

Eigen::VectorXd AxisModel::inner_states_after_sample(double position, double velocity, double input,
                                                     const Eigen::VectorXd& from) {
  for (size_t i = 0; i < inner_states_.size(); ++i)
    numbers_[plan_->signals + inner_states_[i]] = from[Eigen::Index(i)];
  place(position, velocity);
  step_run(input, 0);
  Eigen::VectorXd next(from.size());
  for (size_t i = 0; i < inner_states_.size(); ++i) next[Eigen::Index(i)] = state(inner_states_[i]);
  return next;
}

/// Newton's method on the change over a sample; one step suffices for linear lags and filters.
void AxisModel::let_inner_states_rest(double position, double velocity, double input) {
  constexpr int most_rounds = 12;
  constexpr double settled = 1e-9;  // of the states
  const Eigen::Index n = Eigen::Index(inner_states_.size());
  Eigen::VectorXd at(n);
  for (Eigen::Index i = 0; i < n; ++i) at[i] = state(inner_states_[size_t(i)]);
  const auto after = [&](const Eigen::VectorXd& from) {
    return inner_states_after_sample(position, velocity, input, from);
  };
  for (int round = 0; round < most_rounds; ++round) {
    const Eigen::VectorXd next = after(at);
    const double size = std::max(at.cwiseAbs().maxCoeff(), next.cwiseAbs().maxCoeff());
    if ((next - at).cwiseAbs().maxCoeff() <= settled * size) break;
    if (inner_decay_.size() == 0) {
      inner_decay_ = Eigen::MatrixXd::Zero(n, n);
      for (Eigen::Index i = 0; i < n; ++i) {
        Eigen::VectorXd moved = at;
        moved[i] += size;
        inner_decay_.col(i) = (after(moved) - next) / size;
      }
    }
    const Eigen::MatrixXd stays = Eigen::MatrixXd::Identity(n, n) - inner_decay_;
    at += stays.fullPivLu().solve(next - at);
  }
  after(at);
}

double AxisModel::net_force_at_rest(double position, double velocity, double input, double force) {
  move_to(position, velocity);
  if (!inner_states_.empty())
    let_inner_states_rest(position, velocity, input);
  else if (input_is_filtered_)
    for (int sample = 0; sample < samples_to_settle; ++sample) place(position, velocity), step_run(input, 0);
  return net_force_along(position, velocity, input, force);
}

/// Over the sample that begins now: what has changed the velocity or, while the inertia is not known, by the
/// trapezoidal rule over its steps. Behind a fast pole the force at the instant of a row is still that of the
/// input before it.
double AxisModel::mean_over_sample(double force_now, double input, double push) {
  const int64_t begin = run_->now().tick, end = begin + std::max<int64_t>(1, std::llround(sample_ticks_));
  const double at_first = velocity();
  double sum = 0, before = force_now;
  while (run_->now().tick < end) {
    const int64_t from = run_->now().tick;
    run_->step_fixed(end, false, [] {});
    const double after = held_force(input, push);
    sum += double(run_->now().tick - from) * (before + after) / 2;
    before = after;
  }
  if (nominal_inertia_ > 0) return nominal_inertia_ * (velocity() - at_first) / record_.sample_time - push;
  return sum / double(run_->now().tick - begin);
}

std::vector<double> AxisModel::net_forces(std::span<const double> position, std::span<const double> velocity,
                                          std::span<const double> input, At at) {
  std::vector<double> net;
  net.reserve(input.size());
  set_added_inertia(0);
  start(position[0], velocity[0]);
  const double T = record_.sample_time;
  double last = 0;  // over the sample before
  double push = 0;  // so that the axis keeps to the motion within a sample: what was missing in the last one
  double elapsed = 0;  // [sample times]
  for (size_t k = 0; k < input.size(); ++k) {
    const double before = input[k > 0 ? k - 1 : 0],
                 mean = at == At::mean ? (before + input[k]) / 2 : input[k];
    if (record_.is_map) {
      net.push_back(net_force_at_rest(position[k], velocity[k], input[k], 0));
    } else if (!force_remembers_) {
      run_->move_to(std::llround(elapsed * sample_ticks_));  // sources follow the time
      elapsed += record_.duration.empty() ? 1 : record_.duration[k];
      net.push_back(net_force_along(position[k], velocity[k], mean, 0));
    } else {
      if (k > 0 && nominal_inertia_ > 0) push = nominal_inertia_ * (velocity[k] - velocity[k - 1]) / T - last;
      const double now = net_force_along(position[k], velocity[k], input[k], push) - push;
      const double over_sample = mean_over_sample(now, input[k], push);
      net.push_back(at == At::mean && k > 0 ? (last + over_sample) / 2 : over_sample);
      last = over_sample;
    }
  }
  return net;
}

std::vector<double> AxisModel::force_of_input() {
  if (record_.input.empty()) return {};
  const MeasuredMotion motion = measured_motion(record_);
  const std::vector<double> none(record_.rows(), 0.0);
  const std::vector<double>& position = record_.is_map ? motion.raw_position : motion.position;
  const std::vector<double>& velocity = record_.is_map ? none : motion.velocity;
  const auto net = [&](const std::vector<double>& input) {
    return net_forces(position, velocity, input, At::from_there_on);
  };
  return loopwright::driving_force(net(record_.input), net(none));
}

void AxisModel::relate_force_to_input(const std::optional<Unit>& force_unit) {
  if (record_.input.empty()) return;
  MeasuredMotion motion;
  motion.input = record_.input, motion.input_unit = record_.input_unit;
  motion.force = driving_force_;
  force_unit_ = unit_of_force(force_unit, motion);
  double by_input = 0, squared_input = 0;
  for (size_t k = 0; k < record_.rows(); ++k)
    by_input += driving_force_[k] * record_.input[k], squared_input += record_.input[k] * record_.input[k];
  force_per_input_ = squared_input > 0 ? by_input / squared_input : 0;
}

bool AxisModel::holds_at_rest(double small_force) {
  const MeasuredPort* position = record_.find("position");
  start(position ? std::optional(position->value[0]) : std::nullopt, 0);
  if (net_force(0, small_force) - net_force(0, -small_force) < small_force) return true;
  if (!position) return false;
  // What yields before it slides, or feels only some of the forces, lets every force move the axis. But at
  // the same place it holds back those that come from below and those that come from above, at any speed.
  const auto [low, high] = std::ranges::minmax(position->value);
  const double middle = (low + high) / 2;
  const auto held_back = [&](double speed) {
    net_force_along(low, speed, 0, 0);
    const double from_below = net_force_along(middle, speed, 0, 0);
    net_force_along(high, -speed, 0, 0);
    return net_force_along(middle, -speed, 0, 0) - from_below;
  };
  const double slow = 0.1 * (high - low);                          // per second
  return 2 * held_back(slow) - held_back(2 * slow) > small_force;  // without what grows with the speed
}

}  // namespace loopwright::diagnosis
