/// The diagram files of one load. Each is read once, even if many blocks name it.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>
#include "engine/diagram/block_list.h"
#include "engine/json/tokens.h"
#include "engine/json/problem.h"
#include "engine/json/value.h"

namespace loopwright {

struct DiagramFile {
  std::shared_ptr<const SourceFile> source;  ///< null: cannot be read
  std::optional<JsonTokens> tokens;          ///< nothing: has errors, or has an older version
  Value root;  ///< not an object: has errors, already reported; if there are tokens, it lacks the blocks

  BlockList blocks() const { return tokens ? BlockList(*tokens) : BlockList(root.find("blocks")); }
};

class DiagramLibrary {
 public:
  explicit DiagramLibrary(Problems& problems) : problems_(problems) {}

  /// The file at a path that is named at `reference`, in the current version of the format.
  const DiagramFile& open(const std::string& path, const Place& reference);
  /// A file whose text is in memory: it is not read from the disk.
  void hold(std::shared_ptr<const SourceFile> source);
  /// The identifier of a file: the same text for every spelling of its path.
  const std::string& identity(const std::string& path);
  /// The names of the files read, in order.
  std::vector<std::string> take_names() { return std::move(names_); }

 private:
  void read(DiagramFile& file);
  std::optional<int> version_of(const Value& root);

  Problems& problems_;
  std::unordered_map<std::string, DiagramFile> files_;       // by identity
  std::unordered_map<std::string, std::string> identities_;  // by path: asking the file system takes time
  std::vector<std::string> names_;
};

}  // namespace loopwright
