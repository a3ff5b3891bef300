#include "tools/effects/fragment_text.h"
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include "engine/block/registry.h"
#include "engine/diagram/expression.h"
#include "engine/json/json.h"
#include "tools/effects/json_text.h"
#include "tools/effects/nest.h"
#include "tools/effects/take_out.h"

namespace loopwright {

using Kind = Value::Kind;

std::string FragmentText::block(const Value::Member& block, const std::string& path,
                                const Surroundings& around, Settings& list) const {
  std::string settings, in;
  const auto add = [&](const std::string& name, const std::string& value) {
    if (!value.empty()) settings += fmt::format("{}\"{}\": {}", settings.empty() ? "" : ", ", name, value);
  };
  for (const Value::Member& member : block.value.members) {
    if (member.name == "constants") continue;
    if (member.name == "in") {
      for (const Value::Member& port : member.value.members)
        in += fmt::format("{}\"{}\": {}", in.empty() ? "" : ", ", port.name, wires(port.value, around));
    } else {
      add(member.name, setting(block, member, path, around, list));
    }
  }
  add("constants", constants(block, path + ".constants", list));
  if (in.empty()) return "{" + settings + "}";
  const bool is_long = name_of(block.name).size() + settings.size() + in.size() > 95;
  return fmt::format("{{{},{}\"in\": {{{}}}}}", settings, is_long ? "\n " : " ", in);
}

std::string FragmentText::wires(const Value& port, const Surroundings& around) const {
  if (port.kind != Kind::list) return wire(port, around);
  std::string list;
  for (const Value& item : port.items) list += (list.empty() ? "" : ", ") + wire(item, around);
  return "[" + list + "]";
}

std::string FragmentText::wire(const Value& wire, const Surroundings& around) const {
  const std::string& source = wire.text;
  const size_t dot = source.find('.');
  if (dot != source.npos) return fmt::format("\"{}{}\"", name_of(source.substr(0, dot)), source.substr(dot));
  return fmt::format("\"{}\"", around.wire(source));
}

/// Those of a formula, and the parameters of the effect that it reads: the new diagram has none of these
/// names.
std::string FragmentText::constants(const Value::Member& block, const std::string& path,
                                    Settings& list) const {
  const Value::Member* formula = block.value.find("formula");
  const Value::Member* stated = block.value.find("constants");
  if (!formula) return stated ? value(stated->value, path, list) : "";
  std::vector<std::string> items;
  if (stated)
    for (const Value& item : stated->value.items)
      items.push_back(value(item, fmt::format("{}.{}", path, items.size()), list));
  for (const NameUse& use : names_in(formula->value.text)) {
    const std::string name(use.name);
    const std::string entry = fmt::format("{{\"name\": \"{}\", ", name);
    const auto is_same = [&](const std::string& item) { return item.starts_with(entry); };
    if (!effect_.find(name) || std::ranges::any_of(items, is_same)) continue;
    list.emplace_back(name, fmt::format("{}.{}.value", path, items.size()));
    Value parameter;
    parameter.kind = Kind::text, parameter.text = "=" + name;
    const std::string number = values_.with_unit(parameter, effect_, units_);
    items.push_back(entry + (number.starts_with('{') ? number.substr(1) : "\"value\": " + number + "}"));
  }
  return items.empty() ? "" : fmt::format("[{}]", fmt::join(items, ", "));
}

/// As written in the new diagram; empty: it is left out.
std::string FragmentText::setting(const Value::Member& block, const Value::Member& setting,
                                  const std::string& path, const Surroundings& around,
                                  Settings& settings) const {
  const std::string& text = setting.value.text;
  if (text == "=initial_position" || text == "=initial_velocity")  // those of the motor
    return around.initial(std::string_view(text).substr(1));
  const std::string number = value(setting.value, path + "." + setting.name, settings);
  if (text == switch_value || !is_factor(type_of(block.value), setting.name)) return number;
  return values_.with_unit(setting.value, effect_, units_);
}

std::string FragmentText::value(const Value& value, const std::string& path, Settings& settings) const {
  if (value.kind == Kind::text && value.text == switch_value) return "\"=" + switch_of(base_) + "\"";
  if (value.kind == Kind::text && value.text.starts_with('=')) {
    const std::string name = value.text.substr(1);
    if (effect_.find(name)) settings.emplace_back(name, path);
    // All digits: a sampled block must not drift away from the rows of the record, or of a controller.
    if (name == "sample_time") return fmt::format("{}", values_.evaluate(value));
    return readable_number(values_.evaluate(value));
  }
  std::string items;
  if (value.kind == Kind::list) {
    for (size_t i = 0; i < value.items.size(); ++i)
      items += (i ? ", " : "") + this->value(value.items[i], fmt::format("{}.{}", path, i), settings);
    return "[" + items + "]";
  }
  if (value.kind == Kind::object) {
    for (const Value::Member& m : value.members)
      items += fmt::format("{}\"{}\": {}", items.empty() ? "" : ", ", m.name,
                           this->value(m.value, path + "." + m.name, settings));
    return "{" + items + "}";
  }
  return to_json(value);
}

}  // namespace loopwright
