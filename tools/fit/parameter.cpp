#include "tools/fit/parameter.h"
#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include "engine/block/registry.h"
#include "engine/json/reader.h"

namespace loopwright {
namespace {

struct Limits {
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
  void meet(const ParameterInfo& info) {
    least = std::max(least, info.low), most = std::min(most, info.high);
  }
};

/// The range that a block allows for a number in its settings: the path leads through lists and objects.
const ParameterInfo* info_of_path(const std::vector<ParameterInfo>& list,
                                  const std::vector<std::string>& path, size_t at) {
  for (const ParameterInfo& info : list) {
    if (at >= path.size() || info.name != path[at]) continue;
    if (at + 1 == path.size()) return &info;
    if (!info.fields.empty()) {
      const bool has_index = info.kind == ParameterKind::list;
      return info_of_path(info.fields, path, at + (has_index ? 2 : 1));
    }
  }
  return nullptr;
}

/// Every use of a parameter by itself, "=name", in settings of blocks: their limits apply to it.
void meet_uses(const Value& value, const std::string& name, const BlockType& type,
               std::vector<std::string>& path, Limits& limits) {
  for (const Value::Member& member : value.members) {
    path.push_back(member.name);
    meet_uses(member.value, name, type, path, limits);
    path.pop_back();
  }
  for (size_t i = 0; i < value.items.size(); ++i) {
    path.push_back(std::to_string(i));
    meet_uses(value.items[i], name, type, path, limits);
    path.pop_back();
  }
  if (value.kind == Value::Kind::number && (value.text == name || value.text == "=" + name))
    if (const ParameterInfo* info = info_of_path(type.info.parameters, path, 0)) limits.meet(*info);
}

void meet_uses(const Diagram& diagram, const std::string& name, Limits& limits) {
  for (const BlockEntry& entry : diagram.blocks) {
    if (const BlockType* type = find_block(entry.type)) {
      std::vector<std::string> path;
      meet_uses(entry.settings, name, *type, path, limits);
    }
    if (!entry.subdiagram) continue;
    for (const Parameter& inner : entry.subdiagram->parameters)
      if (inner.value.text == name || inner.value.text == "=" + name)
        meet_uses(*entry.subdiagram, inner.name, limits);
  }
}

std::optional<DiagramNumber> number_of(const Value& value, const std::optional<Unit>& unit,
                                       const Limits& limits) {
  if (value.kind != Value::Kind::number) return {};
  DiagramNumber number{value.number, unit ? unit : std::optional<Unit>(value.unit), limits.least,
                       limits.most};
  if (number.unit) number.unit = number.unit->in_si();
  return number;
}

std::optional<DiagramNumber> in_settings(const BlockEntry& entry, const std::vector<std::string>& path,
                                         size_t at) {
  const Value* value = &entry.settings;
  for (size_t i = at; i < path.size() && value; ++i) {
    size_t index = 0;
    const auto [end, code] = std::from_chars(path[i].data(), path[i].data() + path[i].size(), index);
    if (value->kind == Value::Kind::list && code == std::errc() && index < value->items.size()) {
      value = &value->items[index];
    } else {
      const Value::Member* member = value->find(path[i]);
      value = member ? &member->value : nullptr;
    }
  }
  if (!value) return {};
  Limits limits;
  const BlockType* type = find_block(entry.type);
  const std::vector<std::string> rest(path.begin() + ptrdiff_t(at), path.end());
  if (const ParameterInfo* info = type ? info_of_path(type->info.parameters, rest, 0) : nullptr)
    limits.meet(*info);
  return number_of(*value, {}, limits);
}

}  // namespace

std::optional<DiagramNumber> find_number(const Diagram& diagram, const std::string& text,
                                         Problems& problems) {
  const std::vector<std::string> path = split_path(text);
  const Diagram* at = &diagram;
  KnownNames names;
  for (size_t i = 0; i < path.size(); ++i) {
    names = {};
    for (const Parameter& parameter : at->parameters) {
      names.add(parameter.name);
      if (parameter.name != path[i] || i + 1 != path.size()) continue;
      Limits limits;
      meet_uses(*at, parameter.name, limits);
      if (auto number = number_of(parameter.value, parameter.unit, limits)) return number;
    }
    const BlockEntry* entry = nullptr;
    for (const BlockEntry& block : at->blocks) {
      names.add(block.name);
      if (block.name == path[i]) entry = &block;
    }
    if (!entry) break;
    if (!entry->subdiagram) {
      if (auto number = in_settings(*entry, path, i + 1)) return number;
      for (names = {}; const Value::Member& member : entry->settings.members) names.add(member.name);
      if (i + 1 < path.size()) {
        names.explain(problems.error(entry->place, entry->place.pointer(), entry->name,
                                     fmt::format("\"{}\" is no number of the diagram", text)),
                      path[i + 1]);
        return {};
      }
      break;
    }
    at = entry->subdiagram.get();
  }
  auto& p = problems.error({}, "", "", fmt::format("\"{}\" is no number of the diagram", text));
  names.explain(p, path.empty() ? text : path.back());
  return {};
}

std::pair<std::string, std::string> setting(const std::string& path, const DiagramNumber& number,
                                            double value) {
  if (!number.unit) return {path, fmt::format("{}", value)};
  return {path, fmt::format(R"({{"value": {}, "unit": "{}"}})", value, to_string(*number.unit))};
}

}  // namespace loopwright
