#include "tools/effects/setting_change.h"
#include <algorithm>
#include <fmt/format.h>
#include "engine/diagram/expression.h"

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
    // subdiagram a unit.
    is_bare = is_bare && level.prefix.empty() && parameter && parameter->value.kind == Kind::number;
  }
  return is_bare ? "" : si;
}

/// A new parameter of the diagram.
void declare(const Nest::Level& level, const SettingChange& change, double number, const std::string& unit) {
  const std::string text =
      fmt::format(R"({{"value": {}, {}"description": "{}"}})", readable_number(number),
                  unit.empty() ? "" : fmt::format(R"("unit": "{}", )", unit), change.description);
  TextEdits& edits = level.document->edits;
  const Value::Member* list = level.diagram->find("parameters");
  if (list && !list->value.members.empty()) {
    const Value::Member& first = list->value.members.front();
    edits.insert(first.place.offset, member_before(list->value, first, change.parameter, text));
    return;
  }
  const Value::Member& blocks = *level.diagram->find("blocks");
  edits.insert(blocks.place.offset, member_before(*level.diagram, blocks, "parameters",
                                                  fmt::format(R"({{"{}": {}}})", change.parameter, text)));
}

}  // namespace

ChangedSetting add_to_setting(const Nest::Level& level, const Value& setting, const SettingChange& change) {
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
    replace(readable_number(value.number + *add));
    return ChangedSetting::number;
  }
  if (value.kind != Kind::text || !value.text.starts_with('=')) return ChangedSetting::nothing;
  const std::string expression = value.text.substr(1);
  const std::string own = unit_beside(level, expression, change.unit);
  const auto add = in_unit(change, own.empty() ? written : own);
  if (!add) return ChangedSetting::nothing;
  declare(level, change, *add, own);
  const bool has_lower_rank = expression.find_first_of("?<>=&|") != expression.npos;
  replace(
      fmt::format("\"={} + {}\"", has_lower_rank ? "(" + expression + ")" : expression, change.parameter));
  return ChangedSetting::parameter;
}

}  // namespace loopwright
