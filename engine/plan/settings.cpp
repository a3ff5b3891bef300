#include "engine/plan/settings.h"
#include <algorithm>
#include "engine/json/json.h"

namespace loopwright {
namespace {

/// A matrix of zeros, which fits any unit.
bool is_zeros(const Value& value) {
  if (value.kind == Value::Kind::list) return std::ranges::all_of(value.items, is_zeros);
  return value.kind == Value::Kind::number && value.number == 0;
}

bool has_unit(const Value& value) { return value.unit || std::ranges::any_of(value.items, has_unit); }

/// The description of the items of a list. A number that is a list has an item for each element of a vector.
const ParameterInfo* info_of_items(const ParameterInfo& info) {
  if (!info.element.empty()) return &info.element[0];
  return info.kind == ParameterKind::number ? &info : nullptr;
}

bool has_fixed_unit(const ParameterInfo& info) {
  return !info.unit.empty() && info.unit.find('$') == info.unit.npos;
}

/// Whether a block reads a different number than the one written: hertz where radians are expected, or vice
/// versa.
bool is_converted(const Value& value, const ParameterInfo& info) {
  if (value.unit && has_fixed_unit(info))
    return !value.is_computed && (value.unit->cycles() != 0 || info.unit.find("Hz") != info.unit.npos);
  const ParameterInfo* const items = info_of_items(info);
  if (items &&
      std::ranges::any_of(value.items, [&](const Value& item) { return is_converted(item, *items); }))
    return true;
  return std::ranges::any_of(value.members, [&](const Value::Member& member) {
    const auto field = std::ranges::find(info.fields, member.name, &ParameterInfo::name);
    return field != info.fields.end() && is_converted(member.value, *field);
  });
}

void convert(Value& value, const ParameterInfo& info) {
  if (value.unit && is_converted(value, info))
    if (const auto wanted = parse_unit(info.unit))
      value.number = conversion(*value.unit, *wanted)(value.number);
  if (const ParameterInfo* items = info_of_items(info))
    for (Value& item : value.items) convert(item, *items);
  for (Value::Member& member : value.members)
    for (const ParameterInfo& field : info.fields)
      if (field.name == member.name) convert(member.value, field);
}

std::string text_of(const Value& value, const ParameterInfo& info) {
  if (!is_converted(value, info)) return to_json(value);
  Value converted = value;
  convert(converted, info);
  return to_json(converted);
}

}  // namespace

void Settings::add(const std::vector<Parameter>& parameters) {
  for (const Parameter& parameter : parameters)
    effective.emplace_back(
        parameter.name,
        to_json(parameter.value) + (parameter.value.unit ? " " + to_string(parameter.value.unit->in_si()) : ""));
}

void Settings::add(int block, const BlockType& type, const Value& settings, const std::string& path) {
  for (const ParameterInfo& info : type.info.parameters) {
    const Value::Member* given = settings.find(info.name);
    const bool is_bare = !given || (info.plain_when_bare && !has_unit(given->value));
    if (!is_bare)
      add_numbers(block, info, info.name, given->value, info.plain_when_bare);
    else if (info.plain_when_bare && !(given && info.kind == ParameterKind::list && is_zeros(given->value)))
      with_units.push_back({block, &info, info.name, given ? &given->value : nullptr});
    auto& [name, text] = effective.emplace_back();
    name.reserve(path.size() + 1 + info.name.size());
    name.append(path).append(".").append(info.name);
    text = given ? text_of(given->value, info) : info.default_text;
    if (has_fixed_unit(info)) text.append(" ").append(info.unit);
  }
}

void Settings::add_numbers(int block, const ParameterInfo& info, std::string_view name, const Value& value,
                           bool bare_is_plain) {
  const bool is_plain = bare_is_plain && value.number != 0;  // beside numbers with units, as in a matrix
  if (value.kind == Value::Kind::number && (value.unit || is_plain))
    with_units.push_back({block, &info, name, &value});
  if (const ParameterInfo* items = info_of_items(info))
    for (const Value& item : value.items) add_numbers(block, *items, name, item, bare_is_plain);
  for (const Value::Member& member : value.members)
    for (const ParameterInfo& field : info.fields)
      if (field.name == member.name) add_numbers(block, field, field.name, member.value, bare_is_plain);
}

}  // namespace loopwright
