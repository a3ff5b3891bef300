#include "tools/effects/effect_run.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <stdexcept>
#include "engine/diagram/in_memory.h"
#include "engine/diagram/reader.h"

namespace loopwright {
namespace {

using Kind = Value::Kind;

/// Steps of the solver within a sample, for blocks with states of their own.
constexpr int steps_per_sample = 4;

Value text(std::string words, const Place& place = {}) {
  Value value;
  value.kind = Kind::text, value.text = std::move(words), value.place = place;
  return value;
}
Value number(double n, const Place& place = {}) {
  Value value;
  value.kind = Kind::number, value.number = n, value.place = place;
  return value;
}
Value object(std::vector<Value::Member> members, const Place& place = {}) {
  Value value;
  value.kind = Kind::object, value.members = std::move(members), value.place = place;
  return value;
}
Value list(std::vector<Value> items) {
  Value value;
  value.kind = Kind::list, value.items = std::move(items);
  return value;
}

std::string_view unit_of_role(std::string_view role) {
  if (role == "position") return "$position";
  if (role == "velocity") return "$position/s";
  if (role == "acceleration") return "$position/s^2";
  return "$force";
}

/// The diagram in which an effect runs alone: signals → effect → integrator.
class Bench {
 public:
  Bench(const Effect& effect, const MachineUnits& units, const RecordSizes& sizes)
      : effect_(effect), units_(units), sizes_(sizes), values_(values_of(effect, sizes, starts())) {}

  /// Without `steps`: no integrator.
  Value diagram(std::optional<int> steps) {
    std::vector<Value::Member> blocks, in;
    for (const std::string& role : roles()) {
      blocks.push_back({"given_" + role, {}, object({{"type", {}, text("ExternalSignal")}})});
      in.push_back({role, {}, text("given_" + role + ".y")});
    }
    blocks.push_back({"effect", {}, object({{"diagram", {}, inside()}, {"in", {}, object(std::move(in))}})});
    if (steps)
      blocks.push_back({"integral",
                        {},
                        object({{"type", {}, text("Integrator")},
                                {"in", {}, object({{"u", {}, text("effect.value")}})}})});
    const double step = sizes_.sample_time / steps.value_or(1);
    Value solver =
        object({{"method", {}, text("rk4")}, {"step", {}, number(step)}, {"stop", {}, number(1e6)}});
    return object({{"loopwright", {}, number(1)}, {"solver", {}, solver}, {"blocks", {}, object(blocks)}});
  }

  std::vector<double> starts() const {
    std::vector<double> starts;
    for (const EffectParameter& p : effect_.parameters)
      if (p.is_fitted) starts.push_back(range_of(p, sizes_).start);
    return starts;
  }

 private:
  using To = Attachment::To;
  bool is(To to) const {
    return std::ranges::any_of(effect_.attachments, [&](const Attachment& a) { return a.to == to; });
  }
  /// What is read, and what the effect takes the place of.
  std::vector<std::string> roles() const {
    std::vector<std::string> roles = effect_.reads;
    const auto add = [&](const char* role) {
      if (std::ranges::find(roles, role) == roles.end()) roles.push_back(role);
    };
    if (is(To::input)) add("input");
    if (is(To::sensor)) add("position");
    return roles;
  }

  /// The effect's own blocks, and the sum of what they do.
  Value inside() {
    std::vector<Value::Member> inputs;
    for (const std::string& role : roles())
      inputs.push_back({role, {}, text(unit_in(unit_of_role(role), units_))});
    std::vector<Value> terms;
    std::string signs;
    for (const Attachment& a : effect_.attachments) terms.push_back(text(a.from, a.place)), signs += '+';
    if (is(To::input)) terms.push_back(text("input")), signs += '-';
    if (is(To::sensor)) terms.push_back(text("position")), signs += '-';
    Value blocks = effect_.blocks;
    blocks.members.push_back({"value_of_effect",
                              {},
                              object({{"type", {}, text("Sum")},
                                      {"signs", {}, text(signs)},
                                      {"in", {}, object({{"terms", {}, list(std::move(terms))}})}})});
    Value outputs = object({{"value", {}, object({{"source", {}, text("value_of_effect.sum")}})}});
    return object({{"parameters", {}, parameters()},
                   {"inputs", {}, object(std::move(inputs))},
                   {"outputs", {}, std::move(outputs)},
                   {"blocks", {}, std::move(blocks)}});
  }
  Value parameters() const {
    std::vector<Value::Member> list;
    for (const NamedSize& size : record_sizes)
      list.push_back({std::string(size.name), {}, quantity(sizes_.*size.value, size.unit, {})});
    for (const EffectParameter& p : effect_.parameters)
      list.push_back({p.name, p.place, quantity(values_.at(p.name), p.unit, p.place)});
    return object(std::move(list));
  }
  Value quantity(double value, std::string_view unit, const Place& place) const {
    return object(
        {{"value", place, number(value, place)}, {"unit", place, text(unit_in(unit, units_), place)}}, place);
  }

  const Effect& effect_;
  const MachineUnits& units_;
  const RecordSizes& sizes_;
  EffectValues values_;
};

/// Every expression among the settings of a block, with its path in the plan.
void find_bindings(const Value& value, const std::string& path, std::vector<EffectPlan::Binding>& bindings) {
  if (value.kind == Kind::text && value.text.starts_with('=')) bindings.push_back({path, value});
  if (value.kind == Kind::object) {
    if (const auto* quantity = value.find("value"); quantity && value.find("unit"))
      return;  // a number with a unit is no expression of the effect's
    for (const Value::Member& member : value.members)
      find_bindings(member.value, path + "." + member.name, bindings);
  }
  if (value.kind == Kind::list)
    for (size_t i = 0; i < value.items.size(); ++i)
      find_bindings(value.items[i], fmt::format("{}.{}", path, i), bindings);
}

std::vector<EffectPlan::Binding> bindings_of(const Effect& effect) {
  std::vector<EffectPlan::Binding> bindings;
  for (const Value::Member& block : effect.blocks.members)
    for (const Value::Member& setting : block.value.members)
      if (setting.name != "in" && setting.name != "sample_time")
        find_bindings(setting.value, "effect." + block.name + "." + setting.name, bindings);
  return bindings;
}

/// Whether anything in it keeps more than what its parameters and inputs say. The given signals count their
/// time from the sample.
bool remembers(const Plan& plan) {
  const bool decides = std::ranges::any_of(
      plan.order, [](const Plan::Entry& e) { return e.kind != Plan::Entry::Kind::outputs; });
  return decides || std::ranges::any_of(plan.blocks, [](const Plan::Block& block) {
           const BlockInfo& info = block.type->info;
           if (info.type == "ExternalSignal") return false;
           return info.uses_time || info.is_sampled || info.is_continuous || info.buffers > 0 ||
                  !info.memory_numbers.empty();
         });
}

/// Parameters that change between runs must reach numbers that a run can change.
void check_bindings(const EffectPlan& result, Problems& problems) {
  Run<double> run(result.plan);
  for (const EffectPlan::Binding& binding : result.bindings)
    if (!run.parameter(binding.path))
      problems.error(binding.value.place, binding.value.place.pointer(), binding.path,
                     "this setting of the block is fixed when the diagram is compiled: no parameter of an "
                     "effect can reach it");
}

}  // namespace

std::shared_ptr<const EffectPlan> compile_effect(const Effect& effect, const MachineUnits& units,
                                                 const RecordSizes& sizes, Problems& problems) {
  Problems own;
  auto result = std::make_shared<EffectPlan>();
  result->effect = effect, result->sizes = sizes;
  for (const EffectParameter& p : effect.parameters)
    if (p.is_fitted) result->fitted.push_back(p.name);
  result->bindings = bindings_of(effect);
  Bench bench(effect, units, sizes);
  std::shared_ptr<const Plan> plan;
  // First without an integrator: an effect that has neither states nor rates needs none.
  for (std::optional<int> steps :
       {std::optional<int>(), std::optional<int>(1), std::optional<int>(steps_per_sample)}) {
    const auto diagram = read_diagram(bench.diagram(steps), effect.path, {}, own);
    if (!own.has_errors() && diagram) plan = compile(*diagram, own);
    if (!plan || (!steps && plan->states == 0 && plan->rates.empty()) || (steps && plan->states == 1)) break;
  }
  if (plan && !own.has_errors()) {
    result->plan = *plan;
    result->output = plan->find("effect.value_of_effect.sum").at(0);
    if (const auto integral = plan->find("integral.y"); !integral.empty()) result->integral = integral[0];
    result->acts_on_sensor = std::ranges::any_of(
        effect.attachments, [](const Attachment& a) { return a.to == Attachment::To::sensor; });
    result->remembers = result->integral >= 0 || remembers(*plan);
    check_bindings(*result, own);
  }
  for (const Problem& problem : own.list()) problems.add(problem);
  if (!plan || own.has_errors()) return nullptr;
  return result;
}

size_t RoleSignals::rows() const {
  return std::max({position.size(), velocity.size(), acceleration.size(), input.size(), force.size()});
}

RoleSample RoleSignals::at(size_t row) const {
  const auto value = [row](std::span<const double> column) {
    return row < column.size() ? column[row] : 0.0;
  };
  RoleSample sample{value(position), value(velocity), value(acceleration), value(input), value(force)};
  if (looks_ahead && row + 1 < velocity.size()) sample.next_velocity = velocity[row + 1];
  if (looks_ahead && row + 1 < acceleration.size()) sample.next_acceleration = acceleration[row + 1];
  return sample;
}

EffectRun::EffectRun(std::shared_ptr<const EffectPlan> plan, int lanes) : plan_(std::move(plan)) {
  // A whole arena of lanes costs about as much as four scalar runs.
  const bool is_wide = lanes > 4 || !plan_->remembers;
  const InstructionSet set = is_wide ? widest_instruction_set() : InstructionSet::scalar;
  const int width = lanes_in_arena(set);
  const int sets = set == InstructionSet::scalar || !plan_->remembers ? 1 : std::min(lanes, most_lanes);
  run_ = make_lane_run(plan_->plan, set, (sets + width - 1) / width);
  std::vector<double> starts;
  for (const EffectParameter& p : plan_->effect.parameters)
    if (p.is_fitted) starts.push_back(range_of(p, plan_->sizes).start);
  fitted_.assign(plan_->remembers ? size_t(run_->lanes()) : 1, starts);
  for (int lane = 0; lane < run_->lanes(); ++lane)
    for (std::vector<double*>& bound = bound_.emplace_back();
         const EffectPlan::Binding& binding : plan_->bindings)
      bound.push_back(run_->parameter(binding.path, lane));
  position_ = wire("position"), velocity_ = wire("velocity"), acceleration_ = wire("acceleration");
  input_ = wire("input"), force_ = wire("force");
  sample_ticks_ = std::llround(plan_->sizes.sample_time / plan_->plan.clock.time(1));
  for (auto* list : {&value_, &slope_, &integral_, &second_, &area_})
    list->resize(size_t(run_->lanes()));
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

void EffectRun::Setting::set(double to, size_t from, size_t end) const {
  if (is_row) return std::fill(lanes[from], lanes[from] + (end - from), to);
  for (size_t lane = from; lane < end; ++lane) *lanes[lane] = to;
}

void EffectRun::give(const RoleSample& s, double now, size_t from, size_t to) {
  const double period = plan_->sizes.sample_time;
  const double gain = std::isnan(s.next_velocity) ? s.acceleration : (s.next_velocity - s.velocity) / period;
  const double jerk = std::isnan(s.next_acceleration) ? 0.0 : (s.next_acceleration - s.acceleration) / period;
  const auto give_one = [&](const Wire& wire, double value, double slope, double bend) {
    if (wire.value.lanes.empty()) return;
    wire.value.set(value, from, to), wire.slope.set(slope, from, to);
    wire.bend.set(bend, from, to), wire.since.set(now, from, to);
  };
  give_one(position_, s.position, s.velocity, 0.5 * gain), give_one(velocity_, s.velocity, gain, 0);
  give_one(acceleration_, s.acceleration, jerk, 0), give_one(input_, s.input, 0, 0);
  give_one(force_, s.force, 0, 0);
}

double EffectRun::isolate(size_t parameter, int lane) {
  double size = 1;
  size_t i = 0;
  for (const EffectParameter& p : plan_->effect.parameters) {
    if (!p.is_fitted) continue;
    if (const double start = range_of(p, plan_->sizes).start; i == parameter && start != 0) size = start;
    if (p.is_linear) set(i, i == parameter ? size : 0.0, lane);
    ++i;
  }
  return size;
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

void EffectRun::mean_from(double now) {
  constexpr double gauss_point = 0.21132486540518712;  // (1 - 1/√3) / 2
  const double period = plan_->sizes.sample_time;
  run_->evaluate(plan_->acts_on_sensor ? now : now + gauss_point * period);
  read(plan_->output, value_);
  if (plan_->acts_on_sensor) return;
  run_->evaluate(now + (1 - gauss_point) * period);
  read(plan_->output, second_);
  for (size_t i = 0; i < value_.size(); ++i) {
    slope_[i] = std::numbers::sqrt3 * (second_[i] - value_[i]);
    value_[i] = 0.5 * (value_[i] + second_[i]);
  }
}

/// ∫ (u - ½) f du = mean / 2 - ∫ I du over the sample, u = 0 … 1, with the integral I of f from its start; a
/// straight line of slope s has s / 12.
void EffectRun::integrate_sample() {
  const double period = plan_->sizes.sample_time;
  const std::vector<double>& at_start = second_ = integral_;
  std::ranges::fill(area_, 0.0);
  for (int64_t left = sample_ticks_; left > 0;) {
    run_->evaluate(run_->time());
    if (left == sample_ticks_) read(plan_->output, value_);
    slope_ = integral_;
    const int64_t passed = run_->integrate(std::min(left, std::max<int64_t>(1, sample_ticks_ / steps_per_sample)));
    left -= passed;
    read(plan_->integral, integral_);
    for (size_t i = 0; i < area_.size(); ++i)
      area_[i] += 0.5 * double(passed) / double(sample_ticks_) * (slope_[i] + integral_[i] - 2 * at_start[i]);
  }
  if (plan_->acts_on_sensor) return;
  for (size_t i = 0; i < value_.size(); ++i) {
    const double whole = integral_[i] - at_start[i];
    value_[i] = whole / period, slope_[i] = 12 * (0.5 * whole - area_[i]) / period;
  }
}

void EffectRun::step(const RoleSample& s) {
  const double now = run_->time();
  give(s, now, 0, bound_.size());
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

template <class Take>
void EffectRun::run_side_by_side(const RoleSignals& signals, size_t rows, Take&& take) {
  const double now = run_->time();
  for (size_t first = 0; first < rows; first += bound_.size()) {
    const size_t count = std::min(bound_.size(), rows - first);
    for (size_t i = 0; i < count; ++i) give(signals.at(first + i), now, i, i + 1);
    mean_from(now);
    for (size_t i = 0; i < count; ++i) take(size_t(0), first + i, value_[i], slope_[i]);
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
    output.mean[row] = float(output.factor * value), output.slope[row] = float(output.factor * slope);
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
