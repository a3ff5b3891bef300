#include "tools/effects/written_number.h"
#include <fmt/format.h>
#include <charconv>
#include "engine/json/json.h"
#include "engine/json/reader.h"

namespace loopwright {
namespace {

using Kind = Value::Kind;

/// The position in the text to which a path leads, as `--set` would follow it; empty when it leaves the file.
const Value* find_in_file(const Value& diagram, const std::vector<std::string>& path, size_t at) {
  if (at + 1 == path.size())
    if (const auto* parameters = diagram.find("parameters"))
      if (const auto* own = parameters->value.find(path[at])) return &own->value;
  const Value::Member* blocks = diagram.find("blocks");
  const Value::Member* block = blocks ? blocks->value.find(path[at]) : nullptr;
  if (!block) return nullptr;
  const Value* body = &block->value;
  if (const auto* inner = body->find("diagram")) {
    if (const auto* given = body->find("parameters"); given && at + 2 == path.size())
      if (const auto* own = given->value.find(path[at + 1])) return &own->value;
    return inner->value.kind == Kind::object ? find_in_file(inner->value, path, at + 1) : nullptr;
  }
  for (size_t i = at + 1; i < path.size() && body; ++i) {
    size_t index = 0;
    const auto [end, code] = std::from_chars(path[i].data(), path[i].data() + path[i].size(), index);
    const bool is_index = body->kind == Kind::list && code == std::errc() && index < body->items.size();
    const Value::Member* member = is_index ? nullptr : body->find(path[i]);
    body = is_index ? &body->items[index] : member ? &member->value : nullptr;
  }
  return body;
}

/// Eight digits: more than any record determines.
std::string digits(double number) { return fmt::format("{:.8g}", number); }

}  // namespace

void write_number(const std::shared_ptr<const SourceFile>& file, const Value& root, const std::string& path,
                  double number, TextEdits& edits, Problems& problems) {
  const Value* value = find_in_file(root, split_path(path), 0);
  if (!value) {
    problems.error({file, 0}, "", "", fmt::format("\"{}\" stands in the file of a subdiagram", path)).hint =
        "hand it down as a parameter of the subdiagram's block";
    return;
  }
  Unit written;
  if (const auto* unit = value->find("unit"))
    if (const auto parsed = parse_unit(unit->value.text)) written = *parsed;
  if (const auto* inner = value->find("value")) value = &inner->value;
  if (value->kind != Kind::number) {
    auto& problem = problems.error(value->place, value->place.pointer(), "",
                                   fmt::format("\"{}\" is an expression: it has no number of its own", path));
    problem.found = shown(*value), problem.hint = "fit the parameters that it is made of";
    return;
  }
  const size_t at = value->place.offset;
  edits.replace(at, end_of_value(file->text, at), digits(written.from_si(number)));
}

}  // namespace loopwright
