#include "engine/plan/settings.h"
#include "engine/json/json.h"

namespace loopwright {

void Settings::add(const std::vector<Parameter>& parameters) {
  for (const Parameter& parameter : parameters)
    effective.emplace_back(
        parameter.name,
        to_json(parameter.value) + (parameter.value.unit ? " " + to_string(*parameter.value.unit) : ""));
}

void Settings::add(int block, const BlockType& type, const BlockEntry& entry, const std::string& path) {
  for (const ParameterInfo& info : type.info.parameters) {
    const Value::Member* given = entry.settings.find(info.name);
    if (given) add_numbers(block, info, info.name, given->value);
    auto& [name, text] = effective.emplace_back();
    name.reserve(path.size() + 1 + info.name.size());
    name.append(path).append(".").append(info.name);
    text = given ? to_json(given->value) : info.default_text;
    if (!info.unit.empty() && info.unit.find('$') == info.unit.npos) text.append(" ").append(info.unit);
  }
}

void Settings::add_numbers(int block, const ParameterInfo& info, std::string_view name, const Value& value) {
  if (value.kind == Value::Kind::number && value.unit) with_units.push_back({block, &info, name, &value});
  if (!info.element.empty())
    for (const Value& item : value.items) add_numbers(block, info.element[0], name, item);
  for (const Value::Member& member : value.members)
    for (const ParameterInfo& field : info.fields)
      if (field.name == member.name) add_numbers(block, field, field.name, member.value);
}

}  // namespace loopwright
