#include "engine/json/edit.h"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include "engine/json/json.h"
#include "engine/json/stated_number.h"

namespace loopwright {
namespace {

std::optional<size_t> index_in(const std::string& text) {
  size_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return index;
}

/// "25 mm" as a number with a unit; any other value as it is.
Value with_unit_read(Value value) {
  if (value.kind != Value::Kind::text) return value;
  auto number = number_and_unit(value.text);
  if (!number) return value;
  number->at.place = value.place;
  return number->at;
}

Value read_value(const std::shared_ptr<const SourceFile>& source, Problems& problems) {
  const std::string& text = source->text;
  Value plain;
  plain.kind = Value::Kind::text;
  plain.text = text;
  plain.place = {source, 0};
  if (text.starts_with('=')) return plain;

  Problems syntax;
  Value json = parse_json(source, syntax);
  if (!syntax.has_errors()) return json;
  if (text.starts_with('{') || text.starts_with('[') || text.starts_with('"')) {
    for (const Problem& problem : syntax.list()) problems.add(problem);
    json.is_broken = true;
    return json;
  }
  return with_unit_read(std::move(plain));
}

/// Nothing after a problem.
std::optional<Edit> edit_at(const std::string& path, const Place& place, Problems& problems) {
  Edit edit{split_path(path), 0, {}};
  const auto is_step = [](const std::string& step) { return is_name(step) || index_in(step); };
  if (std::ranges::all_of(edit.path, is_step)) return edit;
  Problem& problem = problems.error(place, place.pointer(), {}, fmt::format("\"{}\" is no path", path));
  problem.expected = "names with dots between them, as in stage.payload";
  return {};
}

/// The number of {"value": 500, "unit": "g"}, or null.
Value* number_beside_unit(Value& value) {
  if (value.kind != Value::Kind::object) return nullptr;
  const auto member = std::ranges::find(value.members, "value", &Value::Member::name);
  const bool has_unit = std::ranges::find(value.members, "unit", &Value::Member::name) != value.members.end();
  return has_unit && member != value.members.end() ? &member->value : nullptr;
}

}  // namespace

std::string Edit::text() const { return fmt::format("{}", fmt::join(path, ".")); }

std::optional<Edit> read_edit(const std::pair<std::string, std::string>& option, Problems& problems) {
  const auto& [path, text] = option;
  const auto source = std::make_shared<SourceFile>(SourceFile{fmt::format("--set {}", path), text});
  auto edit = edit_at(path, {source, 0}, problems);
  if (!edit) return {};
  edit->value = read_value(source, problems);
  if (edit->value.is_broken) return {};
  return edit;
}

std::optional<Edit> read_edit(const Value::Member& setting, Problems& problems) {
  auto edit = edit_at(setting.name, setting.place, problems);
  if (edit) edit->value = with_unit_read(setting.value);
  return edit;
}

void apply_edit(const Edit& edit, Value& value, const Reader& reader,
                const std::function<void(Value&)>& contents) {
  const std::string what = fmt::format("\"{}\" cannot be set", edit.text());
  Value* at = &value;
  for (size_t i = edit.depth; i < edit.path.size(); ++i) {
    const std::string& step = edit.path[i];
    if (contents && step != "file" && step != "name") contents(*at);
    if (at->kind == Value::Kind::object) {
      const auto member = std::ranges::find(at->members, step, &Value::Member::name);
      const bool is_new = member == at->members.end();
      at = is_new ? &at->members.emplace_back(Value::Member{step, edit.value.place, {}}).value
                  : &member->value;
      if (is_new && i + 1 < edit.path.size()) {
        reader.error(edit.value, what).hint = fmt::format("there is no \"{}\" in the file", step);
        return;
      }
    } else if (at->kind == Value::Kind::list) {
      const auto index = index_in(step);
      if (!index || *index >= at->items.size()) {
        Problem& problem = reader.error(edit.value, what);
        problem.expected = at->items.empty() ? "nothing: the list is empty"
                                             : fmt::format("an index from 0 to {}", at->items.size() - 1);
        problem.found = step;
        return;
      }
      at = &at->items[*index];
    } else {
      reader.error(edit.value, what).hint = fmt::format("what stands before \"{}\" is {}", step, shown(*at));
      return;
    }
  }
  const bool is_bare = edit.value.kind == Value::Kind::number && !edit.value.unit;
  if (contents && is_bare) contents(*at);
  Value* const number = number_beside_unit(*at);
  *(number && is_bare ? number : at) = edit.value;
}

}  // namespace loopwright
