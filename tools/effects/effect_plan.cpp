#include "tools/effects/effect_plan.h"
#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include "engine/diagram/in_memory.h"
#include "engine/json/reader.h"
#include "engine/plan/block_settings.h"
#include "engine/run/run.h"
#include "tools/effects/held_effect.h"
#include "tools/effects/linear_effect.h"
#include "tools/effects/switched_effect.h"

namespace loopwright {
namespace {

using Kind = Value::Kind;

/// Steps of the solver within a sample, for blocks with states of their own.
constexpr int steps_per_sample = 4;
/// The same where something is decided, which happens at the start of a step, and again within such a step: a
/// contact that begins late by a step is too weak, and would seem to be harder.
constexpr int steps_per_decision = 16;

Value text_value(std::string words, const Place& place = {}) {
  Value value;
  value.kind = Kind::text, value.text = std::move(words), value.place = place;
  return value;
}
Value number_value(double n, const Place& place = {}) {
  Value value;
  value.kind = Kind::number, value.number = n, value.place = place;
  return value;
}
Value object(std::vector<Value::Member> members, const Place& place = {}) {
  Value value;
  value.kind = Kind::object, value.members = std::move(members), value.place = place;
  return value;
}
Value list_value(std::vector<Value> items) {
  Value value;
  value.kind = Kind::list, value.items = std::move(items);
  return value;
}

std::string_view unit_of_role(std::string_view role) {
  if (role == "position") return "$position";
  if (role == "velocity") return "$position/s";
  if (role == "acceleration") return "$position/s^2";
  return role == "input" ? "$input" : "$force";
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
      blocks.push_back({"given_" + role, {}, object({{"type", {}, text_value("ExternalSignal")}})});
      in.push_back({role, {}, text_value("given_" + role + ".y")});
    }
    blocks.push_back({"effect", {}, object({{"diagram", {}, inside()}, {"in", {}, object(std::move(in))}})});
    if (steps)
      blocks.push_back({"integral",
                        {},
                        object({{"type", {}, text_value("Integrator")},
                                {"in", {}, object({{"u", {}, text_value("effect.value")}})}})});
    const double step = sizes_.sample_time / steps.value_or(1);
    Value solver = object({{"method", {}, text_value("rk4")},
                           {"step", {}, number_value(step)},
                           {"stop", {}, number_value(1e6)}});
    return object(
        {{"loopwright", {}, number_value(1)}, {"solver", {}, solver}, {"blocks", {}, object(blocks)}});
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
  /// The signals that are read, and the one that the effect replaces.
  std::vector<std::string> roles() const {
    std::vector<std::string> roles = effect_.reads;
    const auto add = [&](const char* role) {
      if (std::ranges::find(roles, role) == roles.end()) roles.push_back(role);
    };
    if (is(To::input)) add("input");
    if (is(To::sensor)) add("position");
    return roles;
  }

  /// The effect's own blocks, and the sum of their outputs.
  Value inside() {
    std::vector<Value::Member> inputs;
    for (const std::string& role : roles())
      inputs.push_back({role, {}, text_value(unit_in(unit_of_role(role), units_))});
    std::vector<Value> terms;
    std::string signs;
    for (const Attachment& a : effect_.attachments)
      terms.push_back(text_value(a.from, a.place)), signs += '+';
    if (is(To::input)) terms.push_back(text_value("input")), signs += '-';
    if (is(To::sensor)) terms.push_back(text_value("position")), signs += '-';
    Value blocks = effect_.blocks;
    blocks.members.push_back({"value_of_effect",
                              {},
                              object({{"type", {}, text_value("Sum")},
                                      {"signs", {}, text_value(signs)},
                                      {"in", {}, object({{"terms", {}, list_value(std::move(terms))}})}})});
    Value outputs = object({{"value", {}, object({{"source", {}, text_value("value_of_effect.sum")}})}});
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
    return object({{"value", place, number_value(value, place)},
                   {"unit", place, text_value(unit_in(unit, units_), place)}},
                  place);
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
      return;  // a number with a unit is not an expression of the effect
    for (const Value::Member& member : value.members)
      find_bindings(member.value, path + "." + member.name, bindings);
  }
  if (value.kind == Kind::list)
    for (size_t i = 0; i < value.items.size(); ++i)
      find_bindings(value.items[i], fmt::format("{}.{}", path, i), bindings);
}

/// What the formulas of a block read of the effect and of the record: the compiled diagram has it as further
/// constants of the block.
void find_formula_bindings(const Value::Member& block, const std::vector<Parameter>& parameters,
                           std::vector<EffectPlan::Binding>& bindings) {
  const Value::Member* name = block.value.find("type");
  const BlockType* type = name ? find_block(name->value.text) : nullptr;
  const auto extended = type ? settings_with_constants(type->info, block.value, parameters) : std::nullopt;
  if (!extended) return;
  const Value::Member* written = block.value.find("constants");
  const std::vector<Value>& constants = extended->find("constants")->value.items;
  for (size_t i = written ? written->value.items.size() : 0; i < constants.size(); ++i)
    bindings.push_back({fmt::format("effect.{}.constants.{}.value", block.name, i),
                        text_value("=" + constants[i].find("name")->value.text, block.place)});
}

std::vector<EffectPlan::Binding> bindings_of(const Effect& effect) {
  std::vector<Parameter> parameters;
  const auto add = [&](std::string_view name) {
    parameters.push_back({std::string(name), "", number_value(0), {}, {}});
  };
  for (const NamedSize& size : record_sizes) add(size.name);
  for (const EffectParameter& p : effect.parameters) add(p.name);
  std::vector<EffectPlan::Binding> bindings;
  for (const Value::Member& block : effect.blocks.members) {
    for (const Value::Member& setting : block.value.members)
      if (setting.name != "in" && setting.name != "sample_time")
        find_bindings(setting.value, "effect." + block.name + "." + setting.name, bindings);
    find_formula_bindings(block, parameters, bindings);
  }
  return bindings;
}

/// Whether anything in it depends on more than its parameters and inputs. The given signals count time from
/// the sample.
bool remembers(const Plan& plan) {
  const bool decides = std::ranges::any_of(plan.order, [&](const Plan::Entry& e) {
    const bool forgets =
        e.kind == Plan::Entry::Kind::decide && plan.blocks[size_t(e.block)].type->info.decides_anew;
    return e.kind != Plan::Entry::Kind::outputs && !forgets;
  });
  return decides || std::ranges::any_of(plan.blocks, [](const Plan::Block& block) {
           const BlockInfo& info = block.type->info;
           if (info.type == "ExternalSignal") return false;
           return info.uses_time || info.is_sampled || info.is_continuous || info.buffers > 0 ||
                  !info.memory_numbers.empty();
         });
}

/// Whether all that is remembered is accepted memory, and all of that is numbers.
bool remembers_way(const Plan& plan) {
  const bool decides_nothing = std::ranges::all_of(
      plan.order, [](const Plan::Entry& e) { return e.kind == Plan::Entry::Kind::outputs; });
  return decides_nothing && plan.states == 0 &&
         std::ranges::all_of(plan.blocks, [](const Plan::Block& block) {
           const BlockInfo& info = block.type->info;
           if (info.type == "ExternalSignal") return true;
           return !info.uses_time && !info.is_sampled && info.buffers == 0 &&
                  info.memory_numbers.size() * sizeof(double) == block.type->kernels.memory_size;
         });
}

/// Parameters that change between runs must lead to numbers that a run can change.
void check_bindings(const EffectPlan& result, Problems& problems) {
  Run<double> run(result.plan);
  for (const EffectPlan::Binding& binding : result.bindings)
    if (!run.parameter(binding.path))
      problems.error(binding.value.place, binding.value.place.pointer(), binding.path,
                     "this setting of the block is fixed when the diagram is compiled: no parameter of an "
                     "effect can reach it");
}

void find_slopes(EffectPlan& result, Problems& problems) {
  for (const Attachment& a : result.effect.attachments) {
    if (a.slope.empty()) continue;
    const std::vector<Number> found = result.plan.find("effect." + a.slope);
    if (found.size() == 1)
      result.slopes.push_back(found[0]);
    else
      problems.error(
          a.place, a.place.pointer(), "",
          fmt::format("the slope \"{}\" of the attachment is no output, or not a number", a.slope));
  }
}

/// The same in so many steps a sample.
std::shared_ptr<EffectPlan> with_steps(const EffectPlan& effect, Bench& bench, int steps,
                                       Problems& problems) {
  auto result = std::make_shared<EffectPlan>(effect);
  result->finer = result->coarser = nullptr;
  if (const auto diagram = read_diagram(bench.diagram(steps), effect.effect.path, {}, problems))
    if (const auto plan = compile(*diagram, problems)) result->plan = *plan;
  return result;
}

}  // namespace

std::vector<double> tried_values(const EffectPlan& plan, double FitRange::*at) {
  std::vector<double> fitted;
  for (const EffectParameter& p : plan.effect.parameters) {
    if (!p.is_fitted) continue;
    const FitRange range = range_of(p, plan.sizes);
    fitted.push_back(p.is_linear ? range.start : range.*at);
  }
  return fitted;
}

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
  // First without an integrator: an effect without states and rates needs none.
  for (std::optional<int> steps :
       {std::optional<int>(), std::optional<int>(1), std::optional<int>(steps_per_sample)}) {
    const auto diagram = read_diagram(bench.diagram(steps), effect.path, {}, own);
    if (!own.has_errors() && diagram) plan = compile(*diagram, own);
    if (!plan || (!steps && plan->states == 0 && plan->rates.empty()) || (steps && plan->states == 1)) break;
  }
  if (plan && !own.has_errors()) {
    result->plan = *plan;
    result->output = plan->find("effect.value_of_effect.sum").at(0);
    find_slopes(*result, own);
    if (const auto integral = plan->find("integral.y"); !integral.empty()) result->integral = integral[0];
    result->acts_on_sensor = std::ranges::any_of(
        effect.attachments, [](const Attachment& a) { return a.to == Attachment::To::sensor; });
    result->remembers = result->integral >= 0 || remembers(*plan);
    result->remembers_way = result->remembers && result->integral < 0 && remembers_way(*plan);
    result->flies = plan->states > 1 && std::ranges::any_of(plan->blocks, [](const Plan::Block& block) {
                      return !block.type->info.crossings.empty() && block.path != "integral";
                    });
    check_bindings(*result, own);
    if (!own.has_errors()) result->is_linear = is_linear(result);
    if (!own.has_errors()) result->is_held = is_held(result);
    if (!own.has_errors() && (result->is_switched = is_switched(result))) {
      auto finer = with_steps(*result, bench, steps_per_decision, own);
      Problems unlikely;  // a sample time that cannot be divided so often
      finer->finer = with_steps(*result, bench, steps_per_decision * steps_per_decision, unlikely);
      if (unlikely.has_errors()) finer->finer = nullptr;
      result->finer = std::move(finer);
      auto coarser = with_steps(*result, bench, 1, own);
      coarser->is_switched = false;
      if (resolves(coarser, result)) result->coarser = std::move(coarser);
    }
  }
  for (Problem problem : own.list()) {  // what lies between the blocks and their bench has no file of its own
    if (!problem.place.file) problem.place = effect.blocks.place;
    problems.add(std::move(problem));
  }
  if (!plan || own.has_errors()) return nullptr;
  return result;
}

}  // namespace loopwright
