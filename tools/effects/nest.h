/// A diagram file and the files of its subdiagrams, as texts that are changed together.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>
#include "engine/diagram/drive.h"
#include "engine/json/reader.h"
#include "tools/effects/insert.h"
#include "tools/effects/json_text.h"

namespace loopwright {

std::string wire_text(const Value& wire);
std::string type_of(const Value& block);

/// Calls `f(wire)` for every wire into a block.
template <class F> void each_wire(const Value& block, F&& f) {
  const Value::Member* in = block.find("in");
  if (!in) return;
  for (const Value::Member& port : in->value.members) {
    if (port.value.kind == Value::Kind::text) f(port.value);
    for (const Value& item : port.value.items)
      if (item.kind == Value::Kind::text) f(item);
  }
}

/// Files and diagrams, opened while ports are followed.
class Nest {
 public:
  /// A file of the nest: the outermost diagram, and those of the subdiagrams on the path.
  struct Document {
    std::shared_ptr<const SourceFile> file;
    Value root;
    TextEdits edits;
    Document* parent = nullptr;
    const Value* named_at = nullptr;  // "diagram": "…" in the parent
    const std::string& text() const { return file->text; }
  };

  /// A diagram in the nest.
  struct Level {
    Document* document = nullptr;
    const Value* diagram = nullptr;
    std::string prefix;  // path of its block, empty at the top

    const Value::Member* block(std::string_view name) const {
      const Value::Member* blocks = diagram->find("blocks");
      return blocks ? blocks->value.find(name) : nullptr;
    }
  };

  /// A port that was followed to a block, or to an input of the diagram in which it is read.
  struct Port {
    Level level;
    std::string block, port;                // no block: an input of the level's diagram
    const Value::Member* output = nullptr;  // the last "outputs" entry of a subdiagram on the path
    Level output_level{};
    std::string path() const { return joined(joined(level.prefix, block), port); }
  };

  Nest(std::shared_ptr<const SourceFile> file, const InsertionSite& site, Problems& problems);
  bool is_readable() const { return documents_.front()->root.kind == Value::Kind::object; }
  Level top() const { return {documents_.front().get(), &documents_.front()->root, ""}; }

  /// The body of a block: of its active variant, if it has several.
  const Value* body(const Level& level, const Value::Member& block) const;
  /// The diagram inside a block; empty if it is an ordinary block or cannot be read.
  std::optional<Level> inside(const Level& level, const Value::Member& block);
  /// Follows a port, "axis.position", through outputs of subdiagrams to the block behind it, or to the
  /// diagram input that it denotes. Empty if there is no such port.
  std::optional<Port> follow(const Level& start, const std::string& text);
  /// The changed text, with changed files inlined where they were named.
  std::string text();

 private:
  Document* open(std::shared_ptr<const SourceFile> file, Document* parent, const Value* named_at);
  std::optional<Port> last_step(Port port, const std::string& name);
  /// Paths in a file that is inlined in another folder.
  void rebase(Document& document) const;

  const InsertionSite& site_;
  Problems& problems_;
  std::vector<std::unique_ptr<Document>> documents_;
};

/// The text of a diagram file for another folder: relative paths still lead to the same files.
std::string moved_to_folder(const SourceFile& file, const std::string& folder);

}  // namespace loopwright
