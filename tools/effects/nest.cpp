#include "tools/effects/nest.h"
#include <algorithm>
#include <filesystem>
#include "engine/json/json.h"
#include "tools/effects/file_paths.h"

namespace loopwright {

namespace fs = std::filesystem;
using Kind = Value::Kind;

namespace {

void remove_member(Nest::Document& document, const Value::Member& member) {
  const std::string& text = document.text();
  size_t end = end_of_value(text, member.value.place.offset);
  if (end < text.size() && text[end] == ',')
    end = std::min(text.find_first_not_of(" \t\r\n", end + 1), text.size());
  document.edits.replace(member.place.offset, end, "");
}

}  // namespace

std::string wire_text(const Value& wire) { return wire.kind == Kind::text ? wire.text : ""; }

std::string type_of(const Value& block) {
  const Value::Member* type = block.find("type");
  return type ? type->value.text : "";
}

Nest::Nest(std::shared_ptr<const SourceFile> file, const InsertionSite& site, Problems& problems)
    : site_(site), problems_(problems) {
  open(std::move(file), nullptr, nullptr);
}

const Value* Nest::body(const Level& level, const Value::Member& block) const {
  const Value::Member* variants = block.value.find("variants");
  if (!variants || variants->value.members.empty()) return &block.value;
  std::string name = variants->value.members.front().name;
  if (const auto* chosen = block.value.find("variant")) name = chosen->value.text;
  const auto option = site_.variants.find(joined(level.prefix, block.name));
  if (option != site_.variants.end()) name = option->second;
  const Value::Member* variant = variants->value.find(name);
  return variant ? &variant->value : &variants->value.members.front().value;
}

std::optional<Nest::Level> Nest::inside(const Level& level, const Value::Member& block) {
  const Value* body = this->body(level, block);
  const Value::Member* diagram = body->find("diagram");
  if (!diagram) return {};
  const std::string prefix = joined(level.prefix, block.name);
  if (diagram->value.kind == Kind::object) return Level{level.document, &diagram->value, prefix};
  for (const auto& document : documents_)
    if (document->named_at == &diagram->value) return Level{document.get(), &document->root, prefix};
  const std::string path = resolve_relative(diagram->value.place, diagram->value.text);
  auto file = read_source(path, diagram->value.place, problems_);
  if (!file) return {};
  Document* opened = open(std::move(file), level.document, &diagram->value);
  if (opened->root.kind != Kind::object) return {};
  return Level{opened, &opened->root, prefix};
}

std::optional<Nest::Port> Nest::follow(const Level& start, const std::string& text) {
  std::vector<std::string> path = split_path(text);
  Port port{start, "", "", nullptr, {}};
  for (size_t i = 0; i < path.size(); ++i) {
    const std::string name = path[i].substr(0, path[i].find('['));
    if (i + 1 == path.size()) return last_step(std::move(port), name);
    const Value::Member* block = port.level.block(name);
    if (!block) return {};
    if (auto inner = inside(port.level, *block)) {
      port.level = std::move(*inner);
      continue;
    }
    if (i + 2 != path.size()) return {};
    port.block = name, port.port = path[i + 1];
    return port;
  }
  return {};
}

std::string Nest::text() {
  for (size_t i = documents_.size(); i-- > 1;) {
    Document& document = *documents_[i];
    if (document.edits.empty()) continue;
    rebase(document);
    if (const auto* version = document.root.find("loopwright")) remove_member(document, *version);
    std::string inner = document.edits.apply(document.text());
    while (!inner.empty() && inner.back() == '\n') inner.pop_back();
    const std::string& outer = document.parent->text();
    const size_t at = document.named_at->place.offset;
    const std::string moved = indented(inner, indentation_at(outer, at) + "  ");
    document.parent->edits.replace(at, end_of_value(outer, at), moved);
  }
  return documents_.front()->edits.apply(documents_.front()->text());
}

Nest::Document* Nest::open(std::shared_ptr<const SourceFile> file, Document* parent, const Value* named_at) {
  auto document = std::make_unique<Document>();
  document->file = std::move(file), document->parent = parent, document->named_at = named_at;
  document->root = parse_json(document->file, problems_);
  documents_.push_back(std::move(document));
  return documents_.back().get();
}

std::optional<Nest::Port> Nest::last_step(Port port, const std::string& name) {
  const auto* outputs = port.level.diagram->find("outputs");
  if (const auto* output = outputs ? outputs->value.find(name) : nullptr) {
    const Value* source = &output->value;
    if (source->kind == Kind::object && source->find("source")) source = &source->find("source")->value;
    const Level level = port.level;
    auto behind = follow(level, wire_text(*source));
    if (behind && !behind->output) behind->output = output, behind->output_level = level;
    return behind;
  }
  const auto* inputs = port.level.diagram->find("inputs");
  if (!inputs || !inputs->value.find(name)) return {};
  port.port = name;
  return port;
}

void Nest::rebase(Document& document) const {
  const fs::path outermost = documents_.front()->file->name;
  rebase_paths(document.root, outermost.parent_path().string(), document.edits);
}

std::string moved_to_folder(const SourceFile& file, const std::string& folder) {
  Problems problems;
  const Value root = parse_json(std::make_shared<SourceFile>(file), problems);
  TextEdits edits;
  rebase_paths(root, folder, edits);
  return edits.apply(file.text);
}

}  // namespace loopwright
