#include "tools/effects/effect_lanes.h"
#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include "models/real/whole.h"

namespace loopwright {

EffectLanes::EffectLanes(const EffectPlan& plan, InstructionSet set, int arenas)
    : plan_(plan),
      run_(make_lane_run(plan.plan, set, arenas)),
      sample_ticks_(int64_t(whole_count(std::round(plan.sizes.sample_time / plan.plan.clock.time(1))))) {
  for (int lane = 0; lane < run_->lanes(); ++lane)
    for (std::vector<double*>& bound = bound_.emplace_back();
         const EffectPlan::Binding& binding : plan_.bindings)
      bound.push_back(run_->parameter(binding.path, lane));
  position = wire("position"), velocity = wire("velocity"), acceleration = wire("acceleration");
  input = wire("input"), force = wire("force");
  for (auto* list : {&value, &slope, &stated_slope, &second_}) list->resize(bound_.size());
}

EffectLanes::Wire EffectLanes::wire(const char* role) {
  const auto setting = [&](const char* name) {
    Setting all;
    for (int lane = 0; lane < run_->lanes(); ++lane)
      if (double* number = run_->parameter(fmt::format("given_{}.{}", role, name), lane))
        all.lanes.push_back(number);
    for (double* lane : all.lanes) {
      const bool goes_on = !all.rows.empty() && all.rows.back().data() + all.rows.back().size() == lane;
      if (goes_on)
        all.rows.back() = {all.rows.back().data(), all.rows.back().size() + 1};
      else
        all.rows.emplace_back(lane, 1);
    }
    return all;
  };
  return {setting("value"), setting("slope"), setting("bend"), setting("since")};
}

void EffectLanes::Setting::set(double to) const {
  for (const std::span<double> row : rows) std::ranges::fill(row, to);
}

void EffectLanes::start(const std::vector<std::vector<double>>& fitted, const RoleSample& first) {
  RecordSizes sizes = plan_.sizes;
  sizes.initial_position = first.position, sizes.initial_velocity = first.velocity;
  for (size_t set = 0; set < fitted.size(); ++set) {
    const EffectValues values = values_of(plan_.effect, sizes, fitted[set]);
    for (size_t i = 0; i < plan_.bindings.size(); ++i) {
      const double number = values.evaluate(plan_.bindings[i].value);
      for (size_t lane = set; lane < bound_.size(); lane += fitted.size()) *bound_[lane][i] = number;
    }
  }
  run_->reset({});
}

template <class Put> void EffectLanes::give_by(const GivenSignals& given, Put&& put) {
  using Given = GivenSignals;
  const auto line = [&](const Wire& wire, double at_start, double change) {
    if (wire.is_read()) put(wire.value, at_start), put(wire.slope, change);
  };
  const auto held = [&](const Wire& wire, double at_start) {
    if (wire.is_read()) put(wire.value, at_start);
  };
  line(position, given[Given::position], given[Given::velocity]);
  if (position.is_read()) put(position.bend, 0.5 * given[Given::velocity_slope]);
  line(velocity, given[Given::velocity], given[Given::velocity_slope]);
  line(acceleration, given[Given::acceleration], given[Given::acceleration_slope]);
  held(input, given[Given::input]), held(force, given[Given::force]);
}

void EffectLanes::give(const GivenSignals& given, double since) {
  give_by(given, [](const Setting& setting, double to) { setting.set(to); });
  for (const Wire* wire : {&position, &velocity, &acceleration})
    if (wire->is_read()) wire->since.set(since);
}

void EffectLanes::give(const GivenSignals& given, size_t lane) {
  give_by(given, [lane](const Setting& setting, double to) { *setting.lanes[lane] = to; });
}

void EffectLanes::give_since(double since, size_t lane) {
  for (const Wire* wire : {&position, &velocity, &acceleration})
    if (wire->is_read()) *wire->since.lanes[lane] = since;
}

void EffectLanes::read_first(double at) {
  run_->evaluate(at);
  std::ranges::fill(stated_slope, 0.0);
  for (const Number stated : plan_.slopes) {
    read(stated, value);
    for (size_t i = 0; i < value.size(); ++i) stated_slope[i] += value[i];
  }
  read(plan_.output, value);
}

void EffectLanes::read_second(double at) {
  run_->evaluate(at);
  read(plan_.output, second_);
  for (size_t i = 0; i < value.size(); ++i) {
    slope[i] = std::numbers::sqrt3 * (second_[i] - value[i]) + stated_slope[i];
    value[i] = 0.5 * (value[i] + second_[i]);
  }
}

}  // namespace loopwright
