#include "tools/studio/session/setting_text.h"
#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include "engine/json/json.h"
#include "engine/json/stated_number.h"
#include "tools/studio/session/draft.h"
#include "tools/studio/session/member_change.h"

namespace loopwright::studio {
namespace {

using Kind = Value::Kind;

std::string trimmed(const std::string& text) {
  const size_t begin = text.find_first_not_of(" \t\r\n");
  if (begin == text.npos) return "";
  return text.substr(begin, text.find_last_not_of(" \t\r\n") + 1 - begin);
}

std::optional<Value> json_value(const std::string& text) {
  ParsedText parsed("typed", text);
  if (parsed.problems.has_errors()) return {};
  return parsed.root;
}

bool is_text_kind(const ParameterInfo* info) {
  return info && (info->kind == ParameterKind::text || info->kind == ParameterKind::file ||
                  info->kind == ParameterKind::choice);
}
bool is_number_kind(const ParameterInfo* info) {
  return info && (info->kind == ParameterKind::number || info->kind == ParameterKind::whole);
}

/// What was typed: a number or expression without a unit, a number with one, or JSON.
struct Typed {
  std::string json;
  std::string number, unit;  // of a number with a unit
  bool is_bare = false;      // takes the unit that stands there
};

Typed read_typed(const std::string& typed, const ParameterInfo* info) {
  const std::string text = trimmed(typed);
  if (text.empty()) throw Refused("a value is missing");
  if (text.starts_with('=')) return {in_quotes(text), "", "", true};
  if (is_text_kind(info)) {
    const auto json = text.starts_with('"') ? json_value(text) : std::nullopt;
    return {json ? text : in_quotes(text), "", "", false};
  }
  if (const auto json = json_value(text)) return {text, "", "", json->kind == Kind::number};
  if (const auto number = number_and_unit(text)) {
    const std::string digits = fmt::format("{}", number->number);
    return {fmt::format("{{\"value\": {}, \"unit\": {}}}", digits, in_quotes(number->unit_text)), digits,
            number->unit_text, false};
  }
  if (is_number_kind(info))
    throw Refused(
        fmt::format("\"{}\" is no number; expected a number, a number with a unit (25 mm), or an "
                    "expression (=2*pi*f)",
                    text));
  if (text.find_first_of("{}[]\"") != text.npos) throw Refused(fmt::format("{} is not JSON", text));
  return {in_quotes(text), "", "", false};
}

}  // namespace

std::string typed_text(const Value& value) {
  if (value.kind == Kind::text) return value.text;
  if (value.kind == Kind::object) {
    const Value::Member *number = value.find("value"), *unit = value.find("unit");
    if (number && number->value.kind == Kind::text && number->value.text.starts_with('='))
      return number->value.text;
    if (number && unit && number->value.kind == Kind::number)
      return fmt::format("{} {}", source_of(number->value), unit->value.text);
    if (number && !unit) return typed_text(number->value);
  }
  return std::string(source_of(value));
}

std::string json_of_typed(const std::string& typed, const ParameterInfo* info) {
  return read_typed(typed, info).json;
}

TextChanges retyped(const Value& old, const std::string& typed, const ParameterInfo* info) {
  const Typed read = read_typed(typed, info);
  const Value::Member* number = old.kind == Kind::object ? old.find("value") : nullptr;
  const Value::Member* unit = old.kind == Kind::object ? old.find("unit") : nullptr;
  if (!number) return {replaced(old, read.json)};
  if (read.unit.empty()) {
    // Neither a number nor an expression: a unit has no meaning any more.
    const bool is_whole = !read.is_bare && unit && old.members.size() == 2;
    return {replaced(is_whole ? old : number->value, read.json)};
  }
  TextChanges changes{replaced(number->value, read.number)};
  if (!unit) {
    const size_t at = end_of(number->value);
    changes.push_back({at, at, fmt::format(", \"unit\": {}", in_quotes(read.unit))});
  } else if (unit->value.text != read.unit) {
    changes.push_back(replaced(unit->value, in_quotes(read.unit)));
  }
  return changes;
}

std::string shown_value(const Value& value, const std::string& unit) {
  if (value.is_broken || value.kind == Kind::null) return "";
  if (value.kind == Kind::number) {
    const std::string name = value.unit ? to_string(*value.unit) : unit;
    const bool has_name = !name.empty() && name != "1" && name.find('$') == name.npos;
    return fmt::format("{:.6g}{}", value.number, has_name ? " " + name : "");
  }
  if (value.kind == Kind::boolean) return value.boolean ? "true" : "false";
  if (value.kind == Kind::text) return value.text;
  if (value.kind == Kind::list) {
    constexpr size_t most = 6;
    std::string text;
    for (size_t i = 0; i < std::min(value.items.size(), most); ++i)
      text += (i ? ", " : "") + shown_value(value.items[i], unit);
    return "[" + text + (value.items.size() > most ? ", …]" : "]");
  }
  return "{…}";
}

const ParameterInfo* find_parameter(const std::vector<ParameterInfo>& list,
                                    std::span<const std::string> path) {
  if (path.empty()) return nullptr;
  const auto found = std::ranges::find(list, path.front(), &ParameterInfo::name);
  if (found == list.end()) return nullptr;
  const ParameterInfo* info = &*found;
  for (size_t i = 1; i < path.size(); ++i) {
    const bool is_index = !path[i].empty() && path[i].find_first_not_of("0123456789") == std::string::npos;
    if (is_index && !info->element.empty()) {
      info = &info->element.front();
      continue;
    }
    if (is_index && info->kind == ParameterKind::list && i + 1 < path.size()) continue;
    return find_parameter(info->fields, path.subspan(i));
  }
  return info;
}

std::optional<Slider> slider_around(double si, const std::string& unit, const ParameterInfo* info) {
  std::optional<Unit> parsed = unit.empty() ? Unit{} : parse_unit(unit);
  if (!std::isfinite(si) || !parsed) return {};
  Slider slider{0, 0, parsed->from_si(si), unit == "1" ? "" : unit};
  const double low = info && std::isfinite(info->low) ? parsed->from_si(info->low) : -Reader::infinity;
  const double high = info && std::isfinite(info->high) ? parsed->from_si(info->high) : Reader::infinity;
  const double reach = slider.value == 0 ? 1 : std::abs(slider.value);
  slider.low = std::max(slider.value >= 0 ? (slider.value == 0 && low < 0 ? -reach : 0) : -2 * reach, low);
  slider.high = std::min(slider.value > 0 ? 2 * reach : slider.value == 0 ? reach : 0, high);
  if (info && info->low_is_open && slider.low <= low) slider.low = low + 1e-3 * (slider.high - low);
  if (!(slider.high > slider.low)) return {};
  return slider;
}

}  // namespace loopwright::studio
