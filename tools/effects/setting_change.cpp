#include "tools/effects/setting_change.h"
#include <algorithm>
#include <fmt/format.h>
#include "engine/diagram/expression.h"
#include "tools/effects/take_out.h"

namespace loopwright {
namespace {

using Kind = Value::Kind;

/// What is added, in the unit `written`: a bare number is in SI, and an offset of a scale does not count.
std::optional<double> in_unit(const SettingChange& change, const std::string& written) {
  if (written.empty()) return change.add;
  const auto to = parse_unit(written), from = change.unit.empty() ? to : parse_unit(change.unit);
  if (!from || !to) return {};
  const Conversion turn = conversion(from->in_si(), to->in_si());
  if (turn.kind == Conversion::Kind::impossible || turn.kind == Conversion::Kind::ambiguous) return {};
  return turn(change.add) / to->scale;
}

/// Whether this program added the parameter with an effect: its switch, or a number beside the switch.
bool is_of_an_effect(const Value::Member& parameters, std::string_view name) {
  return std::ranges::any_of(parameters.value.members, [&](const Value::Member& other) {
    return other.name.starts_with(switch_prefix) &&
           (other.name == name || name.starts_with(other.name.substr(switch_prefix.size()) + "_"));
  });
}

/// The unit in which a parameter can be added to an expression of the diagram; empty: a bare number.
std::string unit_beside(const Nest::Level& level, const std::string& expression, const std::string& si) {
  const auto wanted = parse_unit(si);
  const Value::Member* list = level.diagram->find("parameters");
  bool is_bare = true;
  for (const NameUse& use : names_in(expression)) {
    if (use.is_function) continue;
    const Value::Member* parameter = list ? list->value.find(use.name) : nullptr;
    const Value::Member* unit = parameter ? parameter->value.find("unit") : nullptr;
    const auto written = unit ? parse_unit(unit->value.text) : std::nullopt;
    if (written && wanted && written->fits(*wanted)) return unit->value.text;
    // Only the number of an outermost diagram is certainly bare: a block can give a parameter of its
    // subdiagram a unit, but not that of an effect.
    const bool is_number = parameter && parameter->value.kind == Kind::number && level.prefix.empty();
    is_bare = is_bare && (is_number || (parameter && !unit && is_of_an_effect(*list, use.name)));
  }
  return is_bare ? "" : si;
}

}  // namespace

void NewParameters::add(const Nest::Level& level, const std::string& name, double number,
                        const std::string& unit, const std::string& description) {
  auto own = std::ranges::find(diagrams_, level.diagram, [](const OfDiagram& d) { return d.level.diagram; });
  if (own == diagrams_.end()) own = diagrams_.insert(own, {level, {}});
  if (std::ranges::any_of(own->list, [&](const auto& known) { return known.first == name; })) return;
  own->list.emplace_back(
      name, fmt::format(R"({{"value": {}, {}"description": "{}"}})", readable_number(number),
                        unit.empty() ? "" : fmt::format(R"("unit": "{}", )", unit), description));
}

void NewParameters::write() const {
  for (const OfDiagram& own : diagrams_) {
    TextEdits& edits = own.level.document->edits;
    const Value::Member* list = own.level.diagram->find("parameters");
    const bool has_others = list && !list->value.members.empty();
    std::string text;
    for (const auto& [name, value] : own.list)
      text += has_others ? member_before(list->value, list->value.members.front(), name, value)
                         : fmt::format("{}\"{}\": {}", text.empty() ? "" : ", ", name, value);
    if (has_others) {
      edits.insert(list->value.members.front().place.offset, text);
      continue;
    }
    if (list) {  // an empty one
      edits.insert(list->value.place.offset + 1, text);
      continue;
    }
    const Value::Member& blocks = *own.level.diagram->find("blocks");
    edits.insert(blocks.place.offset,
                 member_before(*own.level.diagram, blocks, "parameters", "{" + text + "}"));
  }
}

ChangedSetting add_to_setting(const Nest::Level& level, const Value& setting, const SettingChange& change,
                              NewParameters& parameters) {
  const Value::Member* inner = setting.find("value");
  const Value::Member* unit = setting.find("unit");
  const Value& value = inner ? inner->value : setting;
  const std::string written = unit ? unit->value.text : "";
  const auto replace = [&](const std::string& text) {
    const size_t at = value.place.offset;
    level.document->edits.replace(at, end_of_value(level.document->text(), at), text);
  };
  if (value.kind == Kind::number) {
    const auto add = in_unit(change, written);
    if (!add) return ChangedSetting::nothing;
    replace(change.times.empty() ? readable_number(value.number + *add)
                                 : fmt::format("\"={} + {}*({})\"", readable_number(value.number),
                                               change.times, readable_number(*add)));
    return ChangedSetting::number;
  }
  if (value.kind != Kind::text || !value.text.starts_with('=')) return ChangedSetting::nothing;
  const std::string expression = value.text.substr(1);
  const std::string own = unit_beside(level, expression, change.unit);
  const auto add = in_unit(change, own.empty() ? written : own);
  if (!add) return ChangedSetting::nothing;
  parameters.add(level, change.parameter, *add, own, change.description);
  const bool has_lower_rank = expression.find_first_of("?<>=&|") != expression.npos;
  const std::string added = change.times.empty() ? change.parameter : change.times + "*" + change.parameter;
  replace(fmt::format("\"={} + {}\"", has_lower_rank ? "(" + expression + ")" : expression, added));
  return ChangedSetting::parameter;
}

}  // namespace loopwright
