#include "tools/studio/session/shown_level.h"
#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include "engine/json/json.h"
#include "engine/json/reader.h"

namespace loopwright::studio {
namespace {

using Kind = Value::Kind;

std::string title_of(const Value& diagram, const std::string& otherwise) {
  const std::string_view title = text_in(diagram, "title");
  return title.empty() ? otherwise : std::string(title);
}

}  // namespace

const BlockEntry* entry_of(const Diagram* diagram, const std::string& name) {
  if (!diagram) return nullptr;
  const auto found = std::ranges::find(diagram->blocks, name, &BlockEntry::name);
  return found == diagram->blocks.end() ? nullptr : &*found;
}

ShownLevel find_shown_level(const CheckedText& text, const std::string& inside, const Variants& variants) {
  ShownLevel shown{text.parsed, &text.parsed->root, text.checked.diagram.get(), ""};
  shown.levels.push_back(
      {{"inside", ""},
       {"title",
        title_of(*shown.diagram, std::filesystem::path(text.parsed->file->name).filename().string())}});
  if (inside.empty()) return shown;
  for (const std::string& name : split_path(inside)) {
    const std::string path = joined(shown.inside, name);
    const Value::Member* block = Level{shown.diagram, ""}.block(name);
    const Value* sub = block && block->value.kind == Kind::object
                           ? subdiagram_of(body_of(block->value, path, variants))
                           : nullptr;
    if (!sub) throw Refused(fmt::format("\"{}\" is not a subdiagram", path));
    if (sub->kind == Kind::text) {
      Problems problems;
      const auto file = read_source(resolve_relative(sub->place, sub->text), sub->place, problems);
      if (!file) throw Refused(problems.text());
      shown.owner = std::make_shared<ParsedText>(file->name, file->text);
      shown.diagram = &shown.owner->root, shown.is_editable = false;
    } else {
      shown.diagram = sub;
    }
    if (shown.diagram->kind != Kind::object) throw Refused(fmt::format("\"{}\" cannot be read", path));
    const BlockEntry* entry = entry_of(shown.loaded, name);
    shown.loaded = entry ? entry->subdiagram.get() : nullptr;
    shown.inside = path;
    shown.levels.push_back({{"inside", path}, {"title", title_of(*shown.diagram, name)}});
  }
  return shown;
}

}  // namespace loopwright::studio
