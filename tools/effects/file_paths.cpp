#include "tools/effects/file_paths.h"
#include <filesystem>
#include <functional>
#include <set>
#include "engine/block/registry.h"
#include "engine/diagram/diagram.h"
#include "engine/diagram/value_file.h"
#include "engine/json/json.h"

namespace loopwright {
namespace {

namespace fs = std::filesystem;
using Kind = Value::Kind;
using OnPath = std::function<void(const Value&)>;

constexpr int deepest_nesting = 32;  // a diagram that contains itself is reported when it is loaded

/// The name of the diagram's parameter that a text reads, "=model"; empty: it reads none.
std::string parameter_read_by(const Value& text) {
  return text.text.starts_with('=') ? text.text.substr(text.text.find_first_not_of("= ")) : "";
}

/// Calls `on_path` for every text of the kind `file` among the settings of a block, or of an object in one.
void each_file(const Value& settings, const std::vector<ParameterInfo>& parameters, const OnPath& on_path) {
  for (const ParameterInfo& info : parameters) {
    const Value::Member* member = settings.find(info.name);
    if (!member) continue;
    const bool is_list = info.kind == ParameterKind::list;
    const std::vector<Value>& items = member->value.items;
    const auto look_at = [&](const Value& value) {
      const ParameterKind kind = is_list ? info.element.front().kind : info.kind;
      if (kind == ParameterKind::file && value.kind == Kind::text) on_path(value);
      if (!info.fields.empty()) each_file(value, info.fields, on_path);
    };
    if (is_list)
      for (const Value& item : items) look_at(item);
    else
      look_at(member->value);
  }
}

/// Calls `on_path` for the file of every value that stands in another file.
void each_file_of_values(const Value& value, const OnPath& on_path) {
  if (refers_to_file(value)) on_path(value.find("file")->value);
  for (const Value& item : value.items) each_file_of_values(item, on_path);
  for (const Value::Member& member : value.members)
    if (member.name != "diagram") each_file_of_values(member.value, on_path);
}

/// One diagram and those inside it: which of its texts are paths, and which of its parameters.
class PathFinder {
 public:
  PathFinder(const Value& diagram, OnPath on_path, int depth = 0)
      : on_path_(std::move(on_path)), depth_(depth) {
    if (depth == deepest_nesting) return;
    each_file_of_values(diagram, [this](const Value& text) { found(text); });
    if (const auto* blocks = diagram.find("blocks"))
      for (const Value::Member& block : blocks->value.members) look_into(block.value);
    if (const auto* parameters = diagram.find("parameters")) follow_parameters(parameters->value);
  }
  /// Names of the diagram's parameters that are paths.
  const std::set<std::string>& parameters() const { return parameters_; }

 private:
  void look_into(const Value& block) {
    if (const auto* variants = block.find("variants"))
      for (const Value::Member& variant : variants->value.members) look_into(variant.value);
    if (const auto* diagram = block.find("diagram")) look_into_subdiagram(block, diagram->value);
    if (const auto* type = block.find("type"))
      if (const BlockType* known = find_block(type->value.text))
        each_file(block, known->info.parameters, [this](const Value& text) { found(text); });
  }

  void look_into_subdiagram(const Value& block, const Value& diagram) {
    std::set<std::string> inner;
    if (diagram.kind == Kind::object) {
      inner = PathFinder(diagram, on_path_, depth_ + 1).parameters();
    } else if (diagram.kind == Kind::text && !diagram.text.empty()) {
      on_path_(diagram);
      Problems unheard;  // its problems are reported when the diagram is loaded
      if (const auto file = read_source(resolve_relative(diagram.place, diagram.text), {}, unheard))
        inner = PathFinder(
                    parse_json(file, unheard), [](const Value&) {}, depth_ + 1)
                    .parameters();
    }
    if (const auto* given = block.find("parameters"))
      for (const Value::Member& member : given->value.members)
        if (inner.contains(member.name)) found(text_of(member.value));
  }

  /// A parameter may read another one.
  void follow_parameters(const Value& declared) {
    std::set<std::string> followed;
    while (followed != parameters_) {
      const std::set<std::string> names = parameters_;
      for (const std::string& name : names)
        if (const auto* member = followed.insert(name).second ? declared.find(name) : nullptr)
          found(text_of(member->value));
    }
  }

  /// The same for {"value": …}.
  static const Value& text_of(const Value& parameter) {
    const auto* value = parameter.find("value");
    return value ? value->value : parameter;
  }

  void found(const Value& text) {
    if (text.kind != Kind::text || text.text.empty()) return;
    if (const std::string name = parameter_read_by(text); !name.empty())
      parameters_.insert(name);
    else
      on_path_(text);
  }

  OnPath on_path_;
  int depth_;
  std::set<std::string> parameters_;
};

/// The folder by its canonical name, the file in it by the name that the author chose, symbolic link or not.
fs::path from_root(const fs::path& file) {
  std::error_code code;
  const fs::path whole = fs::absolute(file);
  return fs::weakly_canonical(whole.parent_path(), code) / whole.filename();
}

}  // namespace

void rebase_paths(const Value& diagram, const std::string& folder, TextEdits& edits) {
  if (!diagram.place.file) return;
  std::error_code code;
  const fs::path to = fs::weakly_canonical(fs::absolute(folder.empty() ? "." : folder), code);
  if (to == from_root(diagram.place.file->name).parent_path()) return;
  const auto rebase = [&](const Value& text) {
    if (fs::path(text.text).is_absolute()) return;
    Value moved = text;
    moved.text = from_root(resolve_relative(text.place, text.text)).lexically_relative(to).string();
    const size_t at = text.place.offset;
    edits.replace(at, end_of_value(text.place.file->text, at), to_json(moved));
  };
  PathFinder(diagram, rebase);
  if (const auto* schema = diagram.find("$schema"); schema && schema->value.kind == Kind::text)
    if (schema->value.text.find("://") == std::string::npos) rebase(schema->value);
}

}  // namespace loopwright
