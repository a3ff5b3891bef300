#include "engine/diagram/value_file.h"
#include <charconv>
#include <fmt/format.h>
#include <cmath>
#include "engine/diagram/diagram.h"
#include "engine/diagram/mat_value.h"
#include "engine/json/json.h"

namespace loopwright {
namespace {

/// The element of a list by its number.
const Value* element(const Value& list, std::string_view number) {
  size_t index = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), index);
  const bool is_index = error == std::errc() && end == number.data() + number.size();
  return is_index && index < list.items.size() ? &list.items[index] : nullptr;
}

/// Nothing after a problem at the reference.
const Value* find_named(const Value& file, const Value& name, const std::string& path, const Reader& reader) {
  const Value* value = &file;
  std::string before;  // the parts so far, with a dot behind each
  for (const std::string& part : split_path(name.text)) {
    const Value::Member* const member = value->find(part);
    const Value* const next = member ? &member->value : element(*value, part);
    if (next) {
      value = next, before += part + ".";
      continue;
    }
    auto& problem = reader.error(name, fmt::format("\"{}\" contains no \"{}\"", path, name.text));
    if (value->kind == Value::Kind::list) {
      problem.found = fmt::format("a list of {} at \"{}\"", value->items.size(), part);
      return nullptr;
    }
    if (const std::string reason = why_unusable(*value); !reason.empty())
      problem.found = reason;
    else if (value->kind != Value::Kind::object)
      problem.found = fmt::format("{} before \"{}\"", shown(*value), part);
    KnownNames names;
    for (const Value::Member& known : value->members) names.add(before + known.name);
    names.explain(problem, before + part);
    return nullptr;
  }
  return value;
}

/// Reports expressions, further files, and objects that are not numbers with units.
bool is_plain(const Value& value, const Reader& reader) {
  if (value.kind == Value::Kind::text && value.text.starts_with('=')) {
    reader.error(value, "an expression in a file of values").hint =
        "expressions stand in the diagram, over its parameters";
    return false;
  }
  const bool has_unit = value.members.size() == 2 && value.find("value") && value.find("unit");
  if (value.kind == Value::Kind::object && !has_unit) {
    reader.error(value, "this is no value").expected =
        R"(a number, flag, text or list, or {"value": 5, "unit": "mm"})";
    return false;
  }
  if (has_unit && !is_plain(value.find("value")->value, reader)) return false;
  for (const Value& item : value.items)
    if (!is_plain(item, reader)) return false;
  return true;
}

/// Nothing after a problem.
std::optional<Value> values_of_json(const std::string& path, const Place& reference, const Reader& reader) {
  const auto source = read_source(path, reference, reader.problems);
  if (!source) return {};
  const size_t before = reader.problems.list().size();
  Value content = parse_json(source, reader.problems);
  if (reader.problems.list().size() != before) return {};
  return content;
}

/// The element of a list, ".1.2", that is NaN or infinite; nothing if there is none.
std::optional<std::pair<std::string, double>> not_finite(const Value& value) {
  if (value.kind == Value::Kind::number && !std::isfinite(value.number)) return std::pair("", value.number);
  for (size_t i = 0; i < value.items.size(); ++i)
    if (auto inside = not_finite(value.items[i]))
      return std::pair(fmt::format(".{}{}", i, inside->first), inside->second);
  return {};
}

/// Reports variables of a MAT file that no value can be made of.
bool is_usable(const Value& value, const Value& reference, const Reader& reader) {
  const std::string &file = reference.find("file")->value.text, &name = reference.find("name")->value.text;
  const Value& at = reference.find("name")->value;
  if (const std::string reason = why_unusable(value); !reason.empty()) {
    auto& problem = reader.error(at, fmt::format("\"{}\" in \"{}\" cannot be used", name, file));
    problem.expected = "real numbers in a matrix, a text, or a cell of texts";
    problem.found = reason;
    return false;
  }
  if (const auto wrong = not_finite(value)) {
    auto& problem = reader.error(at, fmt::format("\"{}\" in \"{}\" is not finite", name, file));
    problem.expected = "finite numbers";
    problem.found = fmt::format("{} at {}{}", wrong->second, name, wrong->first);
    return false;
  }
  return true;
}

}  // namespace

bool refers_to_file(const Value& value) {
  return value.kind == Value::Kind::object && value.members.size() == 2 && value.find("file") &&
         value.find("name");
}

Value value_from_file(const Value& reference, const Reader& reader) {
  const Value &file = reference.find("file")->value, &name = reference.find("name")->value;
  if (!reader.expect(file, Value::Kind::text, "\"file\"", "the path of a JSON or MAT file") ||
      !reader.expect(name, Value::Kind::text, "\"name\"", "the name of a value in it"))
    return Value::broken(reference);
  const std::string path = resolve_relative(file.place, file.text);
  const std::optional<Value> content =
      is_mat_path(path) ? values_of_mat(path, reference, reader) : values_of_json(path, file.place, reader);
  const Value* const found = content ? find_named(*content, name, file.text, reader) : nullptr;
  if (!found || !is_usable(*found, reference, reader) || !is_plain(*found, reader))
    return Value::broken(reference);
  return *found;
}

void take_from_file(Value& value, const Reader& reader) {
  if (refers_to_file(value)) value = value_from_file(value, reader);
}

}  // namespace loopwright
