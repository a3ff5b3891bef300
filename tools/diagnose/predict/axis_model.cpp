#include "tools/diagnose/predict/axis_model.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include "engine/run/run.h"
#include "tools/experiment/experiment_ports.h"
#include "tools/experiment/sensor_gains.h"
#include "tools/compare/joined_bodies.h"
#include "tools/compare/machine.h"
#include "tools/diagnose/criteria.h"
#include "tools/diagnose/predict/injection.h"

namespace loopwright::diagnosis {
namespace {

const std::pair<std::string, Place> role(const Experiment& experiment, std::string_view name) {
  for (size_t i = 0; i < experiment.roles.ports.size(); ++i)
    if (experiment.roles.ports[i].first == name)
      return {experiment.roles.ports[i].second, experiment.roles.places[i]};
  return {};
}

Number number_of(const Plan& plan, const std::string& port) {
  const std::vector<Number> numbers = plan.find(port);
  return numbers.size() == 1 ? numbers[0] : -1;
}

/// Shorter ticks, so that samples can have any length: as short as times in 64 bits allow.
void divide_ticks(Plan& plan) {
  constexpr int64_t most = std::numeric_limits<int64_t>::max() / 4;
  const int64_t longest =
      std::max({plan.clock.base.denominator, plan.step_ticks, plan.record_ticks, plan.stop_tick});
  int64_t parts = 1 << 16;
  while (parts > 1 && longest > most / parts) parts /= 2;
  plan.clock.base.denominator *= parts;
  for (int64_t* ticks : {&plan.step_ticks, &plan.record_ticks, &plan.start_tick, &plan.stop_tick})
    *ticks *= parts;
  const auto divide = [parts](auto& rate) { rate.period *= parts, rate.offset *= parts; };
  for (Rate& rate : plan.rates) divide(rate);
  for (Plan::Block& block : plan.blocks) divide(block);
  for (Plan::Entry& entry : plan.order) divide(entry.rate);
  for (Plan::AlgebraicLoop& loop : plan.algebraic_loops)
    for (Plan::Entry& entry : loop.entries) divide(entry.rate);
  for (Plan::Logged& logged : plan.log) divide(logged.rate);
}

/// "axis.mass.mass": the inertia on which this force acts.
std::string inertia_parameter(const Plan& plan, Run<double>& run, Number force) {
  for (const Plan::Block& block : plan.blocks) {
    const bool reads = std::ranges::any_of(
        block.inputs, [&](const auto& port) { return std::ranges::find(port, force) != port.end(); });
    if (!reads || block.states == 0) continue;
    for (const char* name : {"mass", "inertia", "motor_mass", "first_mass"})
      if (run.parameter(block.path + "." + name)) return block.path + "." + name;
  }
  return {};
}

}  // namespace

std::vector<bool> blocks_behind(const Plan& plan, const std::vector<Number>& wanted,
                                const std::vector<int>& beyond) {
  std::vector<bool> needed(plan.blocks.size(), false);
  std::vector<int> todo;
  const auto want = [&](Number n) {
    const int block = n < 0 ? -1 : plan.source_of(n).first;
    if (block < 0 || needed[size_t(block)] || std::ranges::find(beyond, block) != beyond.end()) return;
    needed[size_t(block)] = true, todo.push_back(block);
  };
  for (Number n : wanted) want(n);
  while (!todo.empty()) {
    const Plan::Block& block = plan.blocks[size_t(todo.back())];
    todo.pop_back();
    for (const auto& port : block.inputs)
      for (Number n : port) want(n);
  }
  return needed;
}

void keep_only(Plan& plan, const std::vector<Number>& wanted) {
  const std::vector<bool> needed = blocks_behind(plan, wanted, {});
  std::erase_if(plan.order, [&](const Plan::Entry& entry) {
    return entry.kind != Plan::Entry::Kind::algebraic_loop && !needed[size_t(entry.block)];
  });
}

double step_by_samples(Plan& plan, const AxisRecord& record, int steps) {
  if (!record.duration.empty() || steps > 1) divide_ticks(plan);
  const double ticks = record.sample_time / plan.clock.time(1);
  plan.step_ticks = std::max<int64_t>(1, std::llround(ticks / steps));
  return ticks;
}

AxisModel::AxisModel(const std::string& path, const std::string& experiment_path, const LoadOptions& options,
                     const InputCorrection& correction, size_t rows_in_one) {
  Problems problems;
  const auto experiment = load_experiment(experiment_path, problems);
  const auto whole =
      experiment ? load_diagram(path, with_own_values(*experiment, options), problems) : nullptr;
  const auto whole_plan = whole ? compile(*whole, problems) : nullptr;
  if (!whole_plan || problems.has_errors()) throw InputError(std::move(problems));
  const Experiment cut = cut_open(
      without_sensor_gains(*whole_plan, in_units_of_ports(*whole_plan, *experiment)), *whole_plan, problems);
  const auto [force_port, force_place] = role(cut, "force");
  if (force_port.empty())
    problems.error(cut.place, "/roles", "", "no role \"force\"").expected =
        "\"roles\": {\"force\": the output of the Sum that adds up the forces on the moving part, …}";
  if (problems.has_errors()) throw InputError(std::move(problems));

  LoadOptions driven = follow(cut, options);
  driven.set.emplace_back("solver.step", fmt::format("{}", cut.time.sample_time));
  driven.set.emplace_back("solver.method", "rk4");
  const auto diagram = load_diagram(path, driven, problems);
  std::string parent;
  const auto injected =
      diagram ? with_injected_force(*diagram, force_port, force_place, problems, parent) : nullptr;
  const auto plan = injected ? compile(*injected, problems) : nullptr;
  if (!plan || problems.has_errors()) throw InputError(std::move(problems));
  auto changed = std::make_shared<Plan>(*plan);
  std::optional<Unit> force_unit;  // the source of the input in the original diagram may determine it
  for (const Plan* known : {static_cast<const Plan*>(changed.get()), whole_plan.get()})
    if (const Number number = number_of(*known, force_port); number >= 0 && !force_unit)
      force_unit = known->unit_of(number);
  record_ = read_axis_record(cut, *changed, problems, rows_in_one, correction);
  if (problems.has_errors()) throw InputError(std::move(problems));
  take_noise_away(record_, correction);
  input_ = number_of(*changed, role(cut, "input").first);
  injected_ = number_of(*changed, parent + injected_force + ".y");
  force_ = number_of(*changed, force_port);
  const auto moving = [&](const char* name) {
    const Number number = number_of(*changed, role(cut, name).first);
    return number < 0 ? number : state_behind(*changed, number);
  };
  position_ = moving("position"), velocity_ = moving("velocity");
  if (position_ >= 0 && position_ == velocity_) {
    auto& p = problems.error(role(cut, "velocity").second, "/roles/velocity", "",
                             "the roles \"position\" and \"velocity\" lead to one state");
    p.expected = "the port of the axis' velocity";
    throw InputError(std::move(problems));
  }
  for (MeasuredPort& port : record_.measured) {  // counters and samplers have no slope for a correction
    const Number behind = port.role == "position" ? position_ : velocity_;
    if (behind >= 0 && is_sampled_between(*changed, behind, port.number)) port.number = behind;
  }
  silence(*changed, input_), silence(*changed, injected_);
  std::vector<Number> wanted{force_, position_, velocity_};
  for (const MeasuredPort& port : record_.measured) wanted.push_back(port.number);
  keep_only(*changed, wanted);
  if (position_ >= 0)
    if (const auto unit = plan->unit_of(position_)) position_unit_ = to_string(*unit);
  run_with(*changed, 1);
  start({}, 0);
  if (!record_.find("position")) record_.first_position = position();
  for (Number n : wanted) all_outputs_ |= n >= 0 && n < plan_->signals && n != force_;
  inertia_parameter_ = inertia_parameter(*plan_, *run_, force_);
  if (!inertia_parameter_.empty()) own_inertia_ = *run_->parameter(inertia_parameter_);
  for (int i = 0; i < plan_->states; ++i) seen_.push_back(i);
  look_between_input_and_force();
  follow_fast_forces(*changed);
  driving_force_ = force_of_input();
  const int steps = steps_a_sample_;
  const LinearAxis linear = shorten_steps(*changed);
  if (steps_a_sample_ != steps) driving_force_ = force_of_input();
  relate_force_to_input(force_unit);
  keep_seen_states(linear);
  is_affine_ = is_affine_along_record();
  nominal_inertia_ = linear.inertia, nominal_damping_ = linear.damping;
  if (std::isfinite(nominal_inertia_) && nominal_inertia_ > 0) return;
  if (velocity_ < 0) {
    problems.error(force_place, "/roles", "", "no role \"velocity\"").expected =
        "\"roles\": {\"velocity\": the port of the axis' velocity, measured or not, …}";
    throw InputError(std::move(problems));
  }
  auto& p = problems.error(force_place, "/roles/force", "", "a force there does not accelerate the axis");
  p.expected = "the output of the Sum whose force moves the roles \"velocity\" and \"position\"";
  p.found = fmt::format("an inertia of {:.3g}", nominal_inertia_);
  throw InputError(std::move(problems));
}

AxisModel::~AxisModel() = default;
AxisModel::AxisModel(AxisModel&&) noexcept = default;

void AxisModel::run_with(const Plan& plan, int steps) {
  auto own = std::make_shared<Plan>(plan);
  sample_ticks_ = step_by_samples(*own, record_, steps);
  plan_ = std::move(own), steps_a_sample_ = steps;
  run_ = std::make_unique<Run<double>>(*plan_);
  switch_off_noise(*run_, *plan_);
  numbers_ = reinterpret_cast<double*>(run_->arena().data());
}

/// Until half a step leaves the size of the driving force: where a pole behind it is faster than a step can
/// follow, it grows without bound.
void AxisModel::follow_fast_forces(const Plan& plan) {
  if (record_.is_map || !force_remembers_ || !plan_->steps_between_samples) return;
  const auto size = [&] {
    const std::vector<double> force = force_of_input();
    return Eigen::VectorXd::Map(force.data(), Eigen::Index(force.size())).norm();
  };
  double once = size();
  for (int steps = 1; steps < criteria::most_steps_a_sample; steps *= 2) {
    run_with(plan, 2 * steps);
    const double twice = size();
    if (std::abs(once - twice) <= criteria::same_driving_force * twice) return run_with(plan, steps);
    once = twice;
  }
}

/// Until half a step leads to the same motion. Dry friction with memory remembers every step: linearized over
/// several steps, it would be at another place each time.
LinearAxis AxisModel::shorten_steps(const Plan& plan) {
  LinearAxis linear = linearize_motion();
  if (record_.is_map || !plan_->steps_between_samples || run_->has_accepted_memory()) return linear;
  for (int steps = steps_a_sample_; steps < criteria::most_steps_a_sample; steps *= 2) {
    run_with(plan, 2 * steps);
    LinearAxis shorter = linearize_motion();
    const auto poles = [](const LinearAxis& axis) {
      Eigen::VectorXd sizes = axis.A.eigenvalues().cwiseAbs();
      std::ranges::sort(sizes);
      return sizes;
    };
    const double change = (poles(linear) - poles(shorter)).cwiseAbs().maxCoeff();
    if (change < criteria::same_pole) {
      run_with(plan, steps);
      break;
    }
    linear = std::move(shorter);
  }
  return linear;
}

/// Backward from the measured ports through the linear axis.
void AxisModel::keep_seen_states(const LinearAxis& linear) {
  const size_t n = seen_.size();
  std::vector<bool> seen(n, false);
  for (size_t pass = 0; pass <= n; ++pass)
    for (size_t j = 0; j < n; ++j) {
      const Eigen::Index c = Eigen::Index(j);
      if (linear.C.col(c).cwiseAbs().maxCoeff() > 0) seen[j] = true;
      for (size_t i = 0; i < n; ++i)
        if (seen[i] && linear.A(Eigen::Index(i), c) != 0) seen[j] = true;
    }
  std::vector<int> kept;
  for (size_t i = 0; i < n; ++i)
    if (seen[i]) kept.push_back(seen_[i]);
  seen_ = std::move(kept);
}

bool AxisModel::set_added_inertia(double added) {
  double* parameter = inertia_parameter_.empty() ? nullptr : run_->parameter(inertia_parameter_);
  if (!parameter) return false;
  if (*parameter != own_inertia_ + added) linearized_.reset(), affine_.reset();
  *parameter = own_inertia_ + added;
  return true;
}

bool AxisModel::set_noise_enters_at_input(bool enters) {
  noise_enters_at_input_ = enters;
  linearized_.reset();
  if (record_.is_map || force_per_input_ == 0) return noise_enters_at_input_ = false;
  const LinearAxis axis = linearize();
  const double size = axis.push.norm() * axis.noise_push.norm();
  return size > 0 && std::abs(axis.push.dot(axis.noise_push)) < criteria::same_push * size;
}

void AxisModel::start(std::optional<double> position, double velocity) {
  if (is_affine_ && !affine_) affine_ = affine_sample();
  run_->reset({plan_->seed, 0});
  move_to(position.value_or(this->position()), velocity);
}

void AxisModel::move_to(double position, double velocity) {
  carry_along(*plan_, position_, velocity_, position, velocity, numbers_ + plan_->signals);
  place(position, velocity);
}

void AxisModel::place(double position, double velocity) {
  if (position_ >= plan_->signals) numbers_[position_] = position;
  if (velocity_ >= plan_->signals) numbers_[velocity_] = velocity;
}

double AxisModel::position() const { return position_ < 0 ? 0 : numbers_[position_]; }
double AxisModel::velocity() const { return velocity_ < 0 ? 0 : numbers_[velocity_]; }
double AxisModel::measured(size_t port) const { return numbers_[record_.measured[port].number]; }
double AxisModel::state(int index) const { return numbers_[plan_->signals + index]; }
void AxisModel::correct(int index, double by) { numbers_[plan_->signals + index] += by; }
bool AxisModel::position_follows_velocity() const {
  return !record_.find("position") && record_.measured.front().number == velocity_ &&
         position_ >= plan_->signals && std::ranges::find(seen_, position_ - plan_->signals) == seen_.end();
}
void AxisModel::shift_position(double by) { numbers_[position_] += by; }

}  // namespace loopwright::diagnosis
