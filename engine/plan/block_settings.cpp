#include "engine/plan/block_settings.h"
#include <fmt/format.h>
#include <algorithm>
#include "engine/diagram/expression.h"

namespace loopwright {
namespace {

bool is_vector(const PortInfo& port) { return port.shape == PortInfo::Shape::vector || port.joins_vectors; }

const ParameterInfo* find_parameter(const BlockInfo& info, std::string_view name) {
  const auto found = std::ranges::find(info.parameters, name, &ParameterInfo::name);
  return found == info.parameters.end() ? nullptr : &*found;
}

bool is_by_element(const BlockInfo& info, const Value::Member& member) {
  if (member.value.kind != Value::Kind::list || member.value.items.empty()) return false;
  const ParameterInfo* parameter = find_parameter(info, member.name);
  return parameter && parameter->kind == ParameterKind::number;
}

Value text_value(std::string text, const Place& place) {
  Value value;
  value.kind = Value::Kind::text;
  value.text = std::move(text);
  value.place = place;
  return value;
}

/// {"name": "k", "value": 3, "unit": "N/m"}, at the place of the formula.
Value constant(const Parameter& parameter, const Place& place) {
  Value number;
  number.kind = Value::Kind::number;
  number.number = parameter.value.number;
  number.text = "=" + parameter.name;
  number.place = place;
  Value entry;
  entry.kind = Value::Kind::object;
  entry.place = place;
  entry.members.push_back({"name", place, text_value(parameter.name, place)});
  entry.members.push_back({"value", place, std::move(number)});
  if (parameter.value.unit)
    entry.members.push_back({"unit", place, text_value(to_string(parameter.value.unit->in_si()), place)});
  return entry;
}

/// The texts that are formulas, also inside lists and objects.
void find_formulas(const Value& settings, std::vector<const Value*>& found) {
  for (const Value& item : settings.items) find_formulas(item, found);
  for (const Value::Member& member : settings.members)
    if (member.value.kind != Value::Kind::text)
      find_formulas(member.value, found);
    else if (member.name == "formula" || member.name == "when")
      found.push_back(&member.value);
}

}  // namespace

bool takes_numbers_by_element(const BlockInfo& info) {
  return std::ranges::none_of(info.inputs, is_vector) && std::ranges::none_of(info.outputs, is_vector) &&
         !info.unit_power && !info.formula_unit && !info.unit_claims;
}

std::vector<Value> settings_by_element(const BlockInfo& info, const Value& settings, const std::string& path,
                                       Problems& problems) {
  const Value::Member* first = nullptr;
  for (const Value::Member& member : settings.members) {
    if (!is_by_element(info, member)) continue;
    if (!first) first = &member;
    const size_t wanted = first->value.items.size(), found = member.value.items.size();
    if (found == wanted || !takes_numbers_by_element(info)) continue;
    auto& p = problems.error(
        member.value.place, member.value.place.pointer(), path,
        fmt::format("\"{}\" and \"{}\" have different numbers of elements", first->name, member.name));
    p.expected = fmt::format("a number, or a list of {}", wanted);
    p.found = fmt::format("a list of {}", found);
    return {};
  }
  if (!first || !takes_numbers_by_element(info)) return {};
  std::vector<Value> elements(first->value.items.size(), settings);
  for (size_t e = 0; e < elements.size(); ++e)
    for (Value::Member& member : elements[e].members)
      if (is_by_element(info, member)) {
        Value item = member.value.items[e];  // a copy: it is inside of what it replaces
        member.value = std::move(item);
      }
  return elements;
}

std::optional<Value> settings_with_constants(const BlockInfo& info, const Value& settings,
                                             const std::vector<Parameter>& parameters) {
  if (!find_parameter(info, "constants")) return {};
  std::vector<const Value*> formulas;
  find_formulas(settings, formulas);
  if (formulas.empty()) return {};
  std::vector<std::string_view> hidden;
  for (const std::string_view key : {"names", "inputs"})
    if (const Value::Member* names = settings.find(key))
      for (const Value& name : names->value.items) hidden.push_back(name.text);
  const Value::Member* const written = settings.find("constants");
  if (written)
    for (const Value& entry : written->value.items)
      if (const Value::Member* name = entry.find("name")) hidden.push_back(name->value.text);

  Value list;
  if (written) list = written->value;
  list.kind = Value::Kind::list;
  list.place = written ? written->value.place : formulas[0]->place;
  for (const Value* const formula : formulas)
    for (const NameUse& use : names_in(formula->text)) {
      if (use.is_function || std::ranges::find(hidden, use.name) != hidden.end()) continue;
      const auto parameter = std::ranges::find(parameters, use.name, &Parameter::name);
      if (parameter == parameters.end() || parameter->value.kind != Value::Kind::number) continue;
      list.items.push_back(constant(*parameter, formula->place));
      hidden.push_back(use.name);
    }
  if (list.items.empty()) return {};
  Value result = settings;
  std::erase_if(result.members, [](const Value::Member& member) { return member.name == "constants"; });
  result.members.push_back({"constants", list.place, std::move(list)});
  return result;
}

}  // namespace loopwright
