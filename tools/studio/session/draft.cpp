#include "tools/studio/session/draft.h"
#include <fmt/format.h>
#include <algorithm>
#include "engine/json/json.h"
#include "engine/json/reader.h"

namespace loopwright::studio {

using Kind = Value::Kind;

ParsedText::ParsedText(const std::string& path, std::string text)
    : file(std::make_shared<SourceFile>(SourceFile{path, std::move(text)})) {
  root = parse_json(file, problems);
}

std::string_view text_in(const Value& object, std::string_view name) {
  const Value::Member* member = object.find(name);
  return member && member->value.kind == Kind::text ? std::string_view(member->value.text)
                                                    : std::string_view();
}

const Value& Level::blocks() const {
  static const Value none = [] {
    Value value;
    value.kind = Kind::object;
    return value;
  }();
  const Value::Member* blocks = diagram->find("blocks");
  return blocks && blocks->value.kind == Kind::object ? blocks->value : none;
}

const Value::Member* Level::block(std::string_view name) const { return blocks().find(name); }

std::string variant_of(const Value& block, const std::string& path, const Variants& variants) {
  const Value::Member* list = block.find("variants");
  if (!list || list->value.members.empty()) return "";
  const auto chosen = variants.find(path);
  if (chosen != variants.end() && list->value.find(chosen->second)) return chosen->second;
  const std::string_view written = text_in(block, "variant");
  return list->value.find(written) ? std::string(written) : list->value.members.front().name;
}

const Value& body_of(const Value& block, const std::string& path, const Variants& variants) {
  const std::string variant = variant_of(block, path, variants);
  if (variant.empty()) return block;
  const Value& body = block.find("variants")->value.find(variant)->value;
  return body.kind == Kind::object ? body : block;
}

const Value* subdiagram_of(const Value& body) {
  const Value::Member* diagram = body.find("diagram");
  return diagram ? &diagram->value : nullptr;
}

Level find_level(const Value& root, const std::string& inside, const Variants& variants) {
  if (root.kind != Kind::object) throw Refused("the text is not a JSON object");
  Level level{&root, ""};
  if (inside.empty()) return level;
  for (const std::string& name : split_path(inside)) {
    const Value::Member* block = level.block(name);
    if (!block) throw Refused(fmt::format("there is no block \"{}\"", joined(level.inside, name)));
    const std::string path = joined(level.inside, name);
    const Value* diagram =
        block->value.kind == Kind::object ? subdiagram_of(body_of(block->value, path, variants)) : nullptr;
    if (!diagram) throw Refused(fmt::format("\"{}\" is not a subdiagram", path));
    if (diagram->kind != Kind::object)
      throw Refused(fmt::format("\"{}\" is defined in {}: open that file to change it", path,
                                diagram->kind == Kind::text ? diagram->text : "another file"));
    level.outer.push_back(level.diagram);
    level.diagram = diagram, level.inside = path;
  }
  return level;
}

Draft::Draft(std::string path, std::string text, Variants variants)
    : path_(std::move(path)),
      variants_(std::move(variants)),
      first_size_(text.size()),
      parsed_(std::make_shared<ParsedText>(path_, std::move(text))) {}

void Draft::change(TextChanges changes) {
  if (changes.empty()) return;
  std::ranges::sort(changes, {}, &TextChange::from);
  for (size_t i = 1; i < changes.size(); ++i)
    if (changes[i].from < changes[i - 1].to) throw std::logic_error("changes of a text overlap");
  parsed_ = std::make_shared<ParsedText>(path_, applied(text(), changes));
  changes_ = composed(first_size_, changes_, changes);
}

}  // namespace loopwright::studio
