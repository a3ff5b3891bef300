#include "engine/json/reader.h"

#include <algorithm>
#include <fmt/format.h>
#include "engine/json/unit_hint.h"

namespace loopwright {

std::string shown(const Value& value) {
  constexpr size_t longest = 60;
  switch (value.kind) {
    case Value::Kind::null:
      return "null";
    case Value::Kind::boolean:
      return value.boolean ? "true" : "false";
    case Value::Kind::number:
      return fmt::format("the number {}", value.number);
    case Value::Kind::list:
      return value.items.empty() ? "an empty list" : fmt::format("a list of {}", value.items.size());
    case Value::Kind::object:
      return "an object";
    case Value::Kind::text:
      break;
  }
  if (value.text.size() <= longest) return fmt::format("the text \"{}\"", value.text);
  size_t end = longest;
  while (end > 0 && (value.text[end] & 0xC0) == 0x80) --end;  // do not cut inside a UTF-8 character
  return fmt::format("the text \"{}…\"", value.text.substr(0, end));
}

std::string shown_unit(const Value& number) {
  const std::string unit = *number.unit == Unit{} ? "no dimension" : to_string(*number.unit);
  return number.text.empty() ? unit : fmt::format("{} from {}", unit, number.text);
}

bool is_name(std::string_view text) {
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  return !text.empty() && is_letter(text[0]) &&
         std::ranges::all_of(text, [&](char c) { return is_letter(c) || is_digit(c); });
}

std::vector<std::string> split_path(std::string_view path) {
  std::vector<std::string> names;
  while (true) {
    const size_t dot = path.find('.');
    names.emplace_back(path.substr(0, dot));
    if (dot == path.npos) return names;
    path.remove_prefix(dot + 1);
  }
}

std::string joined(std::string_view path, std::string_view name) {
  return path.empty() ? std::string(name) : fmt::format("{}.{}", path, name);
}

void KnownNames::explain(Problem& problem, std::string_view wrong) {
  constexpr size_t most_listed = 12;
  if (searches_left_-- <= 0) return;
  const std::string near = nearest_name(wrong, names_);
  if (!near.empty())
    problem.hint = fmt::format("did you mean \"{}\"?", near);
  else if (!names_.empty() && names_.size() <= most_listed)
    problem.expected = fmt::format("one of {}", fmt::join(names_, ", "));
}

Problem& Reader::error(const Value& at, std::string message) const {
  return problems.error(at.place, at.place.pointer(), block, std::move(message));
}

Problem& Reader::error(const Value::Member& at, std::string message) const {
  return problems.error(at.place, at.value.place.pointer(), block, std::move(message));
}

bool Reader::expect(const Value& value, Value::Kind kind, std::string_view what,
                    std::string_view expected) const {
  if (value.kind == kind) return true;
  if (value.is_broken) return false;
  Problem& problem = error(value, fmt::format("{} is of the wrong kind", what));
  problem.expected = expected;
  problem.found = shown(value);
  return false;
}

double Reader::number(const Value& value, std::string_view what, double low, double high) const {
  const double nearest = std::clamp(0.0, low, high);
  if (!expect(value, Value::Kind::number, what, "a number")) return nearest;
  if (value.number >= low && value.number <= high) return value.number;
  Problem& problem = error(value, fmt::format("{} is out of range", what));
  problem.expected = high == infinity ? fmt::format("at least {:g}", low)
                                      : fmt::format("a number from {:g} to {:g}", low, high);
  problem.found = shown(value);
  return nearest;
}

double Reader::optional_number(const Value& object, std::string_view key, double otherwise, double low,
                               double high) const {
  const Value::Member* member = object.find(key);
  return member ? number(member->value, fmt::format("\"{}\"", key), low, high) : otherwise;
}

std::string Reader::text(const Value& object, std::string_view key) const {
  const Value::Member* member = object.find(key);
  if (!member || !expect(member->value, Value::Kind::text, fmt::format("\"{}\"", key), "a text in quotes"))
    return {};
  return member->value.text;
}

void Reader::check_version(const Value& file) const {
  text(file, "$schema");
  text(file, "description");
  const Value::Member* version = file.find("loopwright");
  if (version && version->value.kind == Value::Kind::number && version->value.number == 1) return;
  Problem& problem = version ? error(*version, "this version of the format is not known")
                             : error(file, "the version of the format is missing");
  problem.expected = "\"loopwright\": 1";
}

void Reader::reject_unknown(const Value& object, std::initializer_list<std::string_view> known,
                            std::string_view owner) const {
  for (const Value::Member& member : object.members) {
    if (std::ranges::find(known, member.name) != known.end()) continue;
    Problem& problem = error(member, fmt::format("{} has no key \"{}\"", owner, member.name));
    KnownNames({known.begin(), known.end()}).explain(problem, member.name);
  }
}

bool Reader::check_name(const Value::Member& member, std::string_view what) const {
  if (is_name(member.name)) return true;
  Problem& problem = error(member, fmt::format("\"{}\" cannot be the name of {}", member.name, what));
  problem.expected = "letters, digits and underscores, not starting with a digit";
  return false;
}

std::optional<Unit> Reader::unit(const Value& text) const {
  if (!expect(text, Value::Kind::text, "a unit", "a text such as \"N*s/m\"")) return {};
  const auto unit = parse_unit(text.text);
  if (unit) return unit;
  Problem& problem = error(text, fmt::format("there is no unit \"{}\"", text.text));
  problem.hint = unit_hint(text.text);
  problem.expected = "an SI unit such as \"N*m\", \"V*s^2/m\", \"mm\", \"rad/s\", or \"1\"";
  return {};
}

}  // namespace loopwright
