#include "engine/diagram/value_file.h"
#include <charconv>
#include <fmt/format.h>
#include "engine/diagram/diagram.h"
#include "engine/json/json.h"

namespace loopwright {
namespace {

Value broken(const Value& at) {
  Value value;
  value.is_broken = true;
  value.place = at.place;
  return value;
}

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
  for (const std::string& part : split_path(name.text)) {
    const Value::Member* const member = value->find(part);
    const Value* const next = member ? &member->value : element(*value, part);
    if (next) {
      value = next;
      continue;
    }
    auto& problem = reader.error(name, fmt::format("\"{}\" contains no \"{}\"", path, name.text));
    if (value->kind == Value::Kind::list) {
      problem.found = fmt::format("a list of {} at \"{}\"", value->items.size(), part);
      return nullptr;
    }
    KnownNames names;
    for (const Value::Member& known : value->members) names.add(known.name);
    names.explain(problem, part);
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
  for (const Value& item : value.items)
    if (!is_plain(item, reader)) return false;
  return true;
}

}  // namespace

bool refers_to_file(const Value& value) {
  return value.kind == Value::Kind::object && value.members.size() == 2 && value.find("file") &&
         value.find("name");
}

Value value_from_file(const Value& reference, const Reader& reader) {
  const Value &file = reference.find("file")->value, &name = reference.find("name")->value;
  if (!reader.expect(file, Value::Kind::text, "\"file\"", "the path of a JSON file") ||
      !reader.expect(name, Value::Kind::text, "\"name\"", "the name of a value in it"))
    return broken(reference);
  const auto source = read_source(resolve_relative(file.place, file.text), file.place, reader.problems);
  if (!source) return broken(reference);
  const size_t before = reader.problems.list().size();
  const Value content = parse_json(source, reader.problems);
  if (reader.problems.list().size() != before) return broken(reference);
  const Value* const found = find_named(content, name, file.text, reader);
  return found && is_plain(*found, reader) ? *found : broken(reference);
}

}  // namespace loopwright
