#include "tools/effects/effect_run.h"
#include "models/real/whole.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include "tools/effects/switched_effect.h"

namespace loopwright {
namespace {

constexpr double gauss_point = 0.21132486540518712;  // (1 - 1/√3) / 2

/// An end stop or a short pitch is met somewhere within a sample. With few rows in a motion, a sample in
/// which the axis may go farther than a part of its stroke is divided.
size_t parts_of_a_sample(const RecordSizes& sizes) {
  constexpr double farthest = 0.005;  // [stroke] in a part
  constexpr size_t most = 4;
  const double way = sizes.top_speed * sizes.sample_time;
  if (!(way > farthest * sizes.stroke)) return 1;
  return std::min(most, whole_count(std::ceil(way / (farthest * sizes.stroke))));
}

}  // namespace

size_t RoleSignals::rows() const {
  return std::max({position.size(), velocity.size(), acceleration.size(), input.size(), force.size()});
}

RoleSample RoleSignals::at(size_t row) const {
  const auto value = [row](std::span<const double> column) {
    return row < column.size() ? column[row] : 0.0;
  };
  RoleSample sample{value(position), value(velocity), value(acceleration), value(input), value(force)};
  sample.velocity_bow = value(velocity_bow);
  if (looks_ahead && row + 1 < velocity.size()) sample.next_velocity = velocity[row + 1];
  if (looks_ahead && row + 1 < acceleration.size()) sample.next_acceleration = acceleration[row + 1];
  return sample;
}

EffectRun::EffectRun(std::shared_ptr<const EffectPlan> plan, int lanes) : plan_(std::move(plan)) {
  for (const EffectParameter& p : plan_->effect.parameters)
    if (p.is_fitted) starts_.push_back(range_of(p, plan_->sizes).start);
  if (plan_->is_linear) {
    fitted_.assign(size_t(std::max(1, lanes)), starts_);
    linear_ = std::make_unique<EffectSample>(plan_);
    return;
  }
  if (plan_->is_switched) {
    fitted_.assign(size_t(std::max(1, lanes)), starts_);
    return;
  }
  // A complete arena of lanes costs about as much as four scalar runs.
  const bool is_wide = lanes > 4 || !plan_->remembers;
  const InstructionSet set = is_wide ? widest_instruction_set() : InstructionSet::scalar;
  const int width = lanes_in_arena(set);
  const int sets = set == InstructionSet::scalar || !plan_->remembers ? 1 : std::min(lanes, most_lanes);
  run_ = make_lane_run(plan_->plan, set, (sets + width - 1) / width);
  fitted_.assign(plan_->remembers ? size_t(run_->lanes()) : 1, starts_);
  for (int lane = 0; lane < run_->lanes(); ++lane)
    for (std::vector<double*>& bound = bound_.emplace_back();
         const EffectPlan::Binding& binding : plan_->bindings)
      bound.push_back(run_->parameter(binding.path, lane));
  position_ = wire("position"), velocity_ = wire("velocity"), acceleration_ = wire("acceleration");
  input_ = wire("input"), force_ = wire("force");
  sample_ticks_ = int64_t(whole_count(std::round(plan_->sizes.sample_time / plan_->plan.clock.time(1))));
  for (auto* list : {&value_, &slope_, &stated_slope_, &integral_, &second_, &area_})
    list->resize(size_t(run_->lanes()));
  samples_.resize(size_t(run_->lanes()));
}

EffectRun::Wire EffectRun::wire(const char* role) {
  const auto setting = [&](const char* name) {
    Setting all;
    for (int lane = 0; lane < run_->lanes(); ++lane)
      if (double* number = run_->parameter(fmt::format("given_{}.{}", role, name), lane))
        all.lanes.push_back(number);
    for (size_t lane = 0; lane < all.lanes.size(); ++lane)
      all.is_row = all.lanes[lane] == all.lanes[0] + lane && (lane == 0 || all.is_row);
    return all;
  };
  return {setting("value"), setting("slope"), setting("bend"), setting("since")};
}

void EffectRun::Setting::set(double to) const {
  if (is_row)
    std::fill_n(lanes.front(), lanes.size(), to);
  else
    for (double* lane : lanes) *lane = to;
}

double EffectRun::gain_of(const RoleSample& s) const {
  return std::isnan(s.next_velocity) ? s.acceleration
                                     : (s.next_velocity - s.velocity) / plan_->sizes.sample_time;
}
double EffectRun::jerk_of(const RoleSample& s) const {
  return std::isnan(s.next_acceleration) ? 0.0
                                         : (s.next_acceleration - s.acceleration) / plan_->sizes.sample_time;
}
GivenSignals EffectRun::given_at(const RoleSample& s) const {
  return {{s.position, s.velocity, gain_of(s), s.acceleration, jerk_of(s), s.input, s.force}};
}

void EffectRun::give(const GivenSignals& given, double now) {
  using enum GivenSignals::Index;
  const auto give_line = [&](const Wire& wire, double value, double slope) {
    if (wire.value.lanes.empty()) return;
    wire.value.set(value), wire.slope.set(slope), wire.since.set(now);
  };
  const auto give_held = [&](const Wire& wire, double value) {
    if (!wire.value.lanes.empty()) wire.value.set(value);
  };
  // Anything not set here stays zero.
  give_line(position_, given[position], given[velocity]);
  if (!position_.bend.lanes.empty()) position_.bend.set(0.5 * given[velocity_slope]);
  give_line(velocity_, given[velocity], given[velocity_slope]);
  give_line(acceleration_, given[acceleration], given[acceleration_slope]);
  give_held(input_, given[input]), give_held(force_, given[force]);
}

double EffectRun::isolate(size_t parameter, int lane) {
  size_t i = 0;
  for (const EffectParameter& p : plan_->effect.parameters) {
    if (!p.is_fitted) continue;
    if (p.is_linear) set(i, i != parameter ? 0.0 : starts_[i] != 0 ? starts_[i] : 1.0, lane);
    ++i;
  }
  return starts_[parameter] != 0 ? starts_[parameter] : 1;
}

void EffectRun::start(const RoleSample& first) {
  RecordSizes sizes = plan_->sizes;
  sizes.initial_position = first.position, sizes.initial_velocity = first.velocity;
  for (size_t set = 0; set < fitted_.size(); ++set) {
    const EffectValues values = values_of(plan_->effect, sizes, fitted_[set]);
    for (size_t i = 0; i < plan_->bindings.size(); ++i) {
      const double value = values.evaluate(plan_->bindings[i].value);
      for (size_t lane = set; lane < bound_.size(); lane += fitted_.size()) *bound_[lane][i] = value;
    }
  }
  run_->reset({});
  std::ranges::fill(integral_, 0.0);
}

void EffectRun::read_held() {
  std::ranges::fill(stated_slope_, 0.0);
  for (const Number slope : plan_->slopes) {
    read(slope, value_);
    for (size_t i = 0; i < value_.size(); ++i) stated_slope_[i] += value_[i];
  }
  read(plan_->output, value_);
}

void EffectRun::mean_from(double now) {
  const double period = plan_->sizes.sample_time;
  run_->evaluate(plan_->acts_on_sensor ? now : now + gauss_point * period);
  read_held();
  if (plan_->acts_on_sensor) return;
  run_->evaluate(now + (1 - gauss_point) * period);
  read(plan_->output, second_);
  for (size_t i = 0; i < value_.size(); ++i) {
    slope_[i] = std::numbers::sqrt3 * (second_[i] - value_[i]) + stated_slope_[i];
    value_[i] = 0.5 * (value_[i] + second_[i]);
  }
}

/// Where the signals of some rows are at a fraction of their samples, each in a lane of its own, with v = v₀
/// + a t + 6 b u (1 - u), u = t / T, for a bow b. They are held at the instant of evaluation.
void EffectRun::give_at(double u, size_t rows) {
  const double T = plan_->sizes.sample_time;
  const auto give_each = [&](const Wire& wire, auto&& signal) {
    if (wire.value.lanes.empty()) return;
    for (size_t i = 0; i < rows; ++i) *wire.value.lanes[i] = signal(samples_[i], gain_of(samples_[i]) * T);
  };
  give_each(position_, [&](const RoleSample& s, double gain) {
    const double way = (s.velocity + 0.5 * gain * u) * u + s.velocity_bow * u * u * (3 - 2 * u);
    return s.position + T * way;
  });
  give_each(velocity_, [&](const RoleSample& s, double gain) {
    return s.velocity + gain * u + 6 * s.velocity_bow * u * (1 - u);
  });
  give_each(acceleration_, [&](const RoleSample& s, double) { return s.acceleration + jerk_of(s) * T * u; });
  give_each(input_, [](const RoleSample& s, double) { return s.input; });
  give_each(force_, [](const RoleSample& s, double) { return s.force; });
}

/// ∫ f du and 12 ∫ (u - ½) f du over the sample, by two Gauss points in each part of it.
void EffectRun::mean_of(size_t rows, double now) {
  const bool at_start = plan_->acts_on_sensor;
  const size_t parts = parts_of_a_sample(plan_->sizes), points = at_start ? 1 : 2 * parts;
  const double weight = 1.0 / double(points);
  std::ranges::fill(area_, 0.0), std::ranges::fill(slope_, 0.0);
  for (size_t point = 0; point < points; ++point) {
    const double in_part = point % 2 == 0 ? gauss_point : 1 - gauss_point;
    const double u = at_start ? 0 : (double(point / 2) + in_part) / double(parts);
    give_at(u, rows);
    run_->evaluate(now);
    read_held();
    for (size_t i = 0; i < rows; ++i) {
      area_[i] += weight * value_[i];
      slope_[i] += weight * (12 * (u - 0.5) * value_[i] + stated_slope_[i]);
    }
  }
  value_ = area_;
}

/// ∫ (u - ½) f du = mean / 2 - ∫ I du over the sample, u = 0 … 1, with the integral I of f from its start;
/// for a straight line of slope s it is s / 12.
void EffectRun::integrate_sample() {
  const double period = plan_->sizes.sample_time;
  const std::vector<double>& at_start = second_ = integral_;
  std::ranges::fill(area_, 0.0);
  for (int64_t left = sample_ticks_; left > 0;) {
    run_->evaluate(run_->time());
    if (left == sample_ticks_) read_held();
    slope_ = integral_;
    const int64_t passed = run_->integrate(left);  // a step of the solver
    left -= passed;
    read(plan_->integral, integral_);
    for (size_t i = 0; i < area_.size(); ++i)
      area_[i] += 0.5 * double(passed) / double(sample_ticks_) * (slope_[i] + integral_[i] - 2 * at_start[i]);
  }
  if (plan_->acts_on_sensor) return;
  for (size_t i = 0; i < value_.size(); ++i) {
    const double whole = integral_[i] - at_start[i];
    value_[i] = whole / period, slope_[i] = 12 * (0.5 * whole - area_[i]) / period + stated_slope_[i];
  }
}

void EffectRun::step(const RoleSample& s) {
  const double now = run_->time();
  give(given_at(s), now);
  if (plan_->integral >= 0) return integrate_sample();
  mean_from(now);
  run_->integrate(sample_ticks_);
}

template <class Take>
void EffectRun::run_in_turn(const RoleSignals& signals, size_t rows, size_t lanes, Take&& take) {
  for (size_t row = 0; row < rows; ++row) {
    step(signals.at(row));
    for (size_t lane = 0; lane < lanes; ++lane) take(lane, row, value_[lane], slope_[lane]);
  }
}

template <class Take> void EffectRun::run_side_by_side(const RoleSignals& signals, size_t rows, Take&& take) {
  const double now = run_->time();
  give({}, now);  // nothing but the values changes from then on
  for (size_t first = 0; first < rows; first += bound_.size()) {
    const size_t count = std::min(bound_.size(), rows - first);
    for (size_t i = 0; i < count; ++i) samples_[i] = signals.at(first + i);
    mean_of(count, now);
    for (size_t i = 0; i < count; ++i) take(size_t(0), first + i, value_[i], slope_[i]);
  }
}

template <class Take>
void EffectRun::superpose(const RoleSignals& signals, size_t rows, size_t lanes, Take&& take) {
  const RoleSample first = signals.at(0);
  std::vector<SampleMap> maps;
  std::vector<std::vector<double>> states;
  for (size_t lane = 0; lane < lanes; ++lane) {
    linear_->start(fitted_[lane], first.position, first.velocity);
    states.push_back(linear_->states()), maps.push_back(linear_->map());
  }
  SampleMaps side_by_side(maps, states);
  for (size_t row = 0; row < rows; ++row) {
    side_by_side.step(given_at(signals.at(row)));
    for (size_t lane = 0; lane < lanes; ++lane)
      take(lane, row, side_by_side.mean(lane), side_by_side.slope(lane));
  }
}

template <class Take>
void EffectRun::follow_modes(const RoleSignals& signals, size_t rows, size_t lanes, Take&& take) {
  const RoleSample first = signals.at(0);
  for (size_t lane = 0; lane < lanes; ++lane) {
    SwitchedSample sample(plan_, fitted_[lane]);
    std::vector<double> states = sample.start(first.position, first.velocity);
    for (size_t row = 0; row < rows; ++row) {
      const std::vector<double>& result = sample.from(states, given_at(signals.at(row)));
      std::copy_n(result.begin(), states.size(), states.begin());
      take(lane, row, result[states.size()], result[states.size() + 1]);
    }
  }
}

template <class Take>
void EffectRun::run_lanes(const RoleSignals& signals, size_t rows, size_t lanes, Take&& take) {
  for (const std::string& role : plan_->effect.reads) {
    const std::span<const double> column = role == "position"       ? signals.position
                                           : role == "velocity"     ? signals.velocity
                                           : role == "acceleration" ? signals.acceleration
                                           : role == "input"        ? signals.input
                                                                    : signals.force;
    if (column.size() < rows)
      throw std::invalid_argument(
          fmt::format("the effect \"{}\" reads the {}, which is not given", plan_->effect.name, role));
  }
  if (rows == 0) return;
  if (linear_) return superpose(signals, rows, std::min(lanes, fitted_.size()), take);
  if (!run_) return follow_modes(signals, rows, std::min(lanes, fitted_.size()), take);
  start(signals.at(0));
  if (plan_->remembers)
    run_in_turn(signals, rows, std::min(lanes, value_.size()), take);
  else
    run_side_by_side(signals, rows, take);
}

void EffectRun::run(const RoleSignals& signals, size_t rows, std::span<double> values) {
  run_lanes(signals, rows, rows ? values.size() / rows : 0,
            [&](size_t lane, size_t row, double value, double) { values[lane * rows + row] = value; });
}

void EffectRun::run(const RoleSignals& signals, size_t rows, std::span<Output> outputs) {
  for (Output& output : outputs) output.mean.resize(rows), output.slope.resize(rows);
  run_lanes(signals, rows, outputs.size(), [&](size_t lane, size_t row, double value, double slope) {
    Output& output = outputs[lane];
    output.mean[row] = float(output.factor * value);
    output.slope[row] = plan_->acts_on_sensor ? 0.0F : float(output.factor * slope);
  });
}

void EffectRun::column(const RoleSignals& signals, size_t parameter, std::span<double> values) {
  const std::vector<double> kept = fitted_[0];
  const double size = isolate(parameter);
  run(signals, values);
  for (double& value : values) value /= size;
  fitted_[0] = kept;
}

}  // namespace loopwright
