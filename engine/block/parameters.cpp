#include "engine/block/parameters.h"
#include "models/real/whole.h"
#include <fmt/format.h>
#include <cmath>
#include <filesystem>
#include "engine/json/matrix_form.h"
#include "engine/json/stated_number.h"
#include "engine/json/take_unit.h"

namespace loopwright {

static const Value& where(const Value& settings, std::string_view parameter) {
  const Value::Member* member = settings.find(parameter);
  return member ? member->value : settings;
}
Place Checker::place(std::string_view parameter) const { return where(settings_, parameter).place; }
Problem& Checker::error(std::string_view parameter, std::string message) const {
  const Value& value = where(settings_, parameter);
  return problems_.error(value.place, value.place.pointer(), block_, std::move(message));
}
Problem& Checker::warning(std::string_view parameter, std::string message) const {
  const Value& value = where(settings_, parameter);
  return problems_.warning(value.place, value.place.pointer(), block_, std::move(message));
}
std::string Checker::resolve_file(std::string_view parameter, std::string_view path) const {
  const Place at = place(parameter);
  std::string resolved(path);
  if (at.file && !std::filesystem::path(path).is_absolute())
    resolved = (std::filesystem::path(at.file->name).parent_path() / path).string();
  problems_.note_file_name(resolved);
  return resolved;
}

namespace reading {

std::string number_text(double x) { return fmt::format("{}", x); }

static std::string list_text(const Value& v) {
  switch (matrix_form(v)) {
    case MatrixForm::row:
      return fmt::format("a row of {}", v.items.size());
    case MatrixForm::column:
      return fmt::format("a column of {}", v.items.size());
    case MatrixForm::full:
      return fmt::format("a matrix of {} rows and {} columns", v.items.size(), v.items[0].items.size());
    default:
      return fmt::format("a list of {}", v.items.size());
  }
}
static std::string kind_of(const Value& v) {
  switch (v.kind) {
    case Value::Kind::null:
      return "null";
    case Value::Kind::boolean:
      return v.boolean ? "true" : "false";
    case Value::Kind::number:
      return number_text(v.number);
    case Value::Kind::text:
      return "the text \"" + v.text.substr(0, 60) + "\"";
    case Value::Kind::list:
      return list_text(v);
    case Value::Kind::object:
      return "an object";
  }
  return "";
}
static std::string with_unit(std::string_view what, std::string_view unit) {
  return unit.empty() || unit.starts_with('$') ? std::string(what) : fmt::format("{} in {}", what, unit);
}
static std::string range_text(const Range& r) {
  if (r.low == -infinity && r.high == infinity) return "";
  if (r.high == infinity) return fmt::format("{} {}", r.low_is_open ? "above" : "at least", r.low);
  if (r.low == -infinity) return fmt::format("at most {}", r.high);
  return fmt::format("{} {} and at most {}", r.low_is_open ? "above" : "at least", r.low, r.high);
}
static bool wrong_kind(const Value& v, std::string expected, const std::string& block, Problems& problems,
                       std::string_view sentence = {}) {
  if (v.is_broken) return false;  // reported when it was loaded
  auto& p = problems.error(v.place, v.place.pointer(), block, "wrong kind of value");
  p.expected = std::move(expected);
  p.found = kind_of(v);
  p.hint = sentence;
  if (v.kind == Value::Kind::text && p.expected.starts_with("a number")) p.hint = hint_for_quoted_number(v.text);
  return false;
}

/// Whether a number with a unit can be used without conversion. This fast check covers most numbers.
static bool as_described(const Value& v, const Range& range) {
  if (range.is_difference && v.unit->is_point) return false;
  const bool counts_cycles = range.unit.find("Hz") != range.unit.npos;
  const bool is_fixed = range.unit.find('$') == range.unit.npos;
  return !is_fixed || (v.unit->scale == 1 && (v.unit->cycles() == 0) == !counts_cycles);
}
/// False after a problem.
static bool take(Value& v, const Range& range, const Reader& reader) {
  if (range.is_difference && v.unit->is_point) {
    auto& p = reader.error(v, "a difference of temperatures is no temperature");
    p.expected = "a number in K";
    p.found = fmt::format("{} K above absolute zero, from a scale with a zero of its own", v.number);
    p.hint = range.sentence;
    return false;
  }
  const auto unit = parse_unit(range.unit);
  const UnitTaken taken = unit ? take_unit(v, *unit, reader) : UnitTaken::no;
  if (taken == UnitTaken::no) v.unit = {};  // reported where the units of all wires are checked
  return taken != UnitTaken::told;
}

bool number(double& to, const Value& v, const Range& range, const std::string& block, Problems& problems) {
  if (v.kind != Value::Kind::number)
    return wrong_kind(v, with_unit("a number", range.unit), block, problems, range.sentence);
  if (v.unit && !as_described(v, range)) {
    Value taken = v;
    if (!take(taken, range, {problems, block})) return false;
    return number(to, taken, range, block, problems);
  }
  const bool inside = std::isfinite(v.number) && v.number >= range.low && v.number <= range.high &&
                      !(range.low_is_open && v.number <= range.low);
  if (!inside) {
    auto& p = problems.error(v.place, v.place.pointer(), block, "the number is out of range");
    p.expected = with_unit(fmt::format("a number {}", range_text(range)), range.unit);
    p.found = number_text(v.number) + (v.text.empty() ? "" : " from " + v.text);
    p.hint = range.sentence;
    return false;
  }
  to = v.number;
  return true;
}
bool whole(int64_t& to, const Value& v, const Range& range, const std::string& block, Problems& problems) {
  double x = 0;
  if (v.kind == Value::Kind::number && v.number != std::floor(v.number))
    return wrong_kind(v, "a whole number", block, problems, range.sentence);
  if (!number(x, v, range, block, problems)) return false;
  to = whole_between(x, std::numeric_limits<int64_t>::min(), std::numeric_limits<int64_t>::max());
  return true;
}
bool flag(bool& to, const Value& v, const std::string& block, Problems& problems) {
  if (v.kind != Value::Kind::boolean) return wrong_kind(v, "true or false", block, problems);
  to = v.boolean;
  return true;
}
bool text(std::string& to, const Value& v, const std::string& block, Problems& problems) {
  if (v.kind != Value::Kind::text) return wrong_kind(v, "a text in quotes", block, problems);
  to = v.text;
  return true;
}
int choice(const Value& v, const std::vector<std::string_view>& names, const std::string& block,
           Problems& problems) {
  std::string all;
  for (size_t i = 0; i < names.size(); ++i) {
    if (v.kind == Value::Kind::text && v.text == names[i]) return int(i);
    all += fmt::format("{}\"{}\"", i == 0 ? "" : i + 1 == names.size() ? " or " : ", ", names[i]);
  }
  wrong_kind(v, all, block, problems);
  return -1;
}
bool list(const Value& v, const std::string& block, std::string_view sentence, Problems& problems) {
  return v.kind == Value::Kind::list || wrong_kind(v, "a list, as in [1, 2]", block, problems, sentence);
}
bool object(const Value& v, const std::string& block, Problems& problems) {
  return v.kind == Value::Kind::object || wrong_kind(v, "an object in braces", block, problems);
}
void missing(const Value& object, std::string_view name, std::string_view unit, std::string_view sentence,
             const std::string& block, Problems& problems) {
  auto& p = problems.error(object.place, object.place.pointer(), block,
                           fmt::format("the parameter \"{}\" is missing", name));
  p.expected = fmt::format("\"{}\": {}", name, with_unit("a value", unit));
  p.hint = sentence;
}
void unknown_keys(const Value& object, std::span<const std::string_view> names, const std::string& block,
                  Problems& problems) {
  for (const Value::Member& member : object.members) {
    bool known = false;
    for (const std::string_view name : names) known |= member.name == name;
    if (known) continue;
    auto& p = problems.error(member.place, member.value.place.pointer(), block,
                             fmt::format("there is no parameter \"{}\"", member.name));
    const std::string near = nearest_name(member.name, {names.begin(), names.end()});
    if (!near.empty())
      p.hint = fmt::format("did you mean \"{}\"?", near);
    else
      for (const std::string_view name : names)
        p.expected.append(p.expected.empty() ? "one of " : ", ").append(name);
  }
}

}  // namespace reading
}  // namespace loopwright
