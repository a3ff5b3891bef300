#include "tools/sweep/tunables.h"
#include <fmt/format.h>
#include <functional>
#include "engine/json/json.h"

namespace loopwright {
namespace {

const double* find(const Plan::Block& block, std::string_view path) {
  return block.type->kernels.tunable(const_cast<void*>(block.value.get()),
                                     path);  // finds it, changes nothing
}

/// f(path inside the block, number) for each tunable number below a parameter.
using Found = std::function<void(const std::string& path, double number)>;
void each_number(const Plan::Block& block, const std::string& path, const ParameterInfo& info,
                 const Found& f) {
  if (const double* number = find(block, path)) return f(path, *number);
  if (info.kind == ParameterKind::object)
    for (const ParameterInfo& field : info.fields)
      each_number(block, fmt::format("{}.{}", path, field.name), field, f);
  if (info.kind != ParameterKind::list) return;
  bool found = true;
  for (size_t i = 0; found; ++i) {
    found = false;
    each_number(block, fmt::format("{}.{}", path, i), info.element[0], [&](const std::string& p, double x) {
      found = true;
      f(p, x);
    });
  }
}

/// The JSON text of a setting with its tunable numbers removed.
void strike_out(const Plan::Block& block, const std::string& path, Value& value) {
  if (value.kind == Value::Kind::number && find(block, path)) value = Value{};
  for (size_t i = 0; i < value.items.size(); ++i)
    strike_out(block, fmt::format("{}.{}", path, i), value.items[i]);
  for (Value::Member& member : value.members)
    strike_out(block, fmt::format("{}.{}", path, member.name), member.value);
}

std::string without_numbers(const Plan::Block& block, const ParameterInfo& info, std::string text) {
  const std::string unit = fmt::format(" {}", info.unit);
  if (!info.unit.empty() && text.ends_with(unit)) text.resize(text.size() - unit.size());
  Problems problems;
  Value value = parse_json(std::make_shared<SourceFile>(SourceFile{"", text}), problems);
  if (problems.has_errors()) return text;
  strike_out(block, std::string(info.name), value);
  return to_json(value);
}

}  // namespace

std::map<std::string, double> tunable_numbers(const Plan& plan) {
  std::map<std::string, double> numbers;
  for (const Plan::Block& block : plan.blocks)
    for (const ParameterInfo& info : block.type->info.parameters)
      each_number(block, std::string(info.name), info, [&](const std::string& path, double number) {
        numbers.emplace(fmt::format("{}.{}", block.path, path), number);
      });
  return numbers;
}

std::string skeleton(const Plan& plan) {
  std::map<std::string, std::string_view> settings;
  for (const auto& [path, value] : plan.parameters) settings.emplace(path, value);
  std::string text = fmt::format("{} {} {} {} {} {} {} {} {} {} {}\n", plan.clock.base.numerator,
                                 plan.clock.base.denominator, plan.start_tick, plan.stop_tick,
                                 plan.step_ticks, plan.record_ticks, to_name(plan.method), plan.seed,
                                 plan.relative_tolerance, plan.absolute_tolerance, plan.maximum_step);
  for (const Plan::Block& block : plan.blocks) {
    text += fmt::format("{} {} {} {} {} {}", block.path, block.type->info.type, block.period, block.offset,
                        block.first_state, block.first_buffer);
    for (const auto& port : block.inputs) {
      text += " |";
      for (const Number n : port) text += fmt::format(" {}", n);
    }
    if (block.gate >= 0) text += fmt::format(" if {}", plan.gates[size_t(block.gate)].on);
    for (const ParameterInfo& info : block.type->info.parameters) {
      const auto setting = settings.find(fmt::format("{}.{}", block.path, info.name));
      if (setting != settings.end())
        text +=
            fmt::format("\n {} {}", info.name, without_numbers(block, info, std::string(setting->second)));
    }
    text += "\n";
  }
  return text;
}

}  // namespace loopwright
