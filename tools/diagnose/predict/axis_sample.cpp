/// A sample of the axis: by the run of its diagram, or, where that is linear, by what it comes to.
#include <algorithm>
#include <cmath>
#include "engine/run/run.h"
#include "tools/diagnose/predict/axis_model.h"

namespace loopwright::diagnosis {
namespace {

/// States of the blocks that are computed.
std::vector<int> computed_states(const Plan& plan) {
  std::vector<bool> is_computed(plan.blocks.size(), false);
  for (const Plan::Entry& entry : plan.order)
    if (entry.kind != Plan::Entry::Kind::algebraic_loop) is_computed[size_t(entry.block)] = true;
  std::vector<int> states;
  for (size_t b = 0; b < plan.blocks.size(); ++b)
    for (int i = 0; is_computed[b] && i < plan.blocks[b].states; ++i)
      states.push_back(plan.blocks[b].first_state + i);
  return states;
}

/// By how much two runs differ, beside how large a state is and how much a sample changes it.
struct Agreement {
  double difference = 0, size = 0, change = 0;

  void add(double before, double after, double other) {
    const double d = std::abs(after - other);
    difference = d <= difference ? difference : d;  // what is no number stays
    size = std::max(size, std::abs(after)), change = std::max(change, std::abs(after - before));
  }
  bool is_good() const {
    constexpr double same_change = 1e-9, same_size = 1e-13;  // some roundings
    return difference <= same_change * change + same_size * size;
  }
};

}  // namespace

void AxisModel::step(double input, double force, double duration) {
  if (affine_ && duration == 1) return affine_->step(numbers_ + plan_->signals, input, force);
  step_run(input, force, duration);
}

void AxisModel::step_run(double input, double force, double duration) {
  numbers_[input_] = input;
  numbers_[injected_] = force;
  const int64_t end = run_->now().tick + std::max<int64_t>(1, std::llround(duration * sample_ticks_));
  while (run_->now().tick < end) run_->step_fixed(end, false, [] {});
  if (all_outputs_) run_->evaluate(0, true);
}

AffineSample AxisModel::affine_sample() {
  return {affine_states_, [&](std::vector<double>& states, double input, double force) {
            run_->reset({plan_->seed, 0});
            double* all = numbers_ + plan_->signals;
            for (size_t i = 0; i < states.size(); ++i) all[affine_states_[i]] = states[i];
            step_run(input, force, 1);
            for (size_t i = 0; i < states.size(); ++i) states[i] = all[affine_states_[i]];
          }};
}

/// Along the whole record both ways lead to the same states, with forces up to twice those that drive the
/// axis. What a curve, a stop or a memory of the diagram does there shows.
bool AxisModel::is_affine_along_record() {
  affine_states_ = computed_states(*plan_);
  const bool may_be = !record_.is_map && !all_outputs_ && record_.duration.empty() &&
                      !run_->has_accepted_memory() && affine_states_.size() <= AffineSample::most_states;
  if (!may_be) return false;
  const AffineSample sample = affine_sample();
  double largest = 0;
  for (double f : driving_force_) largest = std::max(largest, std::abs(f));
  const MeasuredPort* position = record_.find("position");
  const MeasuredPort* velocity = record_.find("velocity");
  start({}, 0);
  std::vector<double> before(size_t(plan_->states)), other;
  std::vector<Agreement> agreements(before.size());
  double* all = numbers_ + plan_->signals;
  for (size_t k = 0; k + 1 < record_.rows(); ++k) {
    const double speed =
        velocity ? velocity->value[k] : (position->value[k + 1] - position->value[k]) / record_.sample_time;
    place(position ? position->value[k] : this->position(), speed);
    before.assign(all, all + plan_->states), other = before;
    const double force = largest * (double(k % 5) - 2);
    step_run(record_.input[k], force, 1);
    sample.step(other.data(), record_.input[k], force);
    for (size_t i = 0; i < before.size(); ++i) agreements[i].add(before[i], all[i], other[i]);
  }
  return std::ranges::all_of(agreements, &Agreement::is_good);
}

}  // namespace loopwright::diagnosis
