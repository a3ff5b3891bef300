/// Nested diagrams during loading.
#pragma once
#include <memory>
#include <string>
#include <vector>
#include "engine/diagram/block_list.h"
#include "engine/diagram/diagram.h"
#include "engine/json/edit.h"
#include "engine/diagram/library.h"
#include "engine/diagram/parameter_scope.h"
#include "engine/diagram/variants.h"

namespace loopwright {

/// One use of a diagram file, with the options that apply to it.
struct Instance {
  std::string block;  // path of the subdiagram block; empty at the top
  std::vector<Override> overrides;
  std::vector<Edit> edits;
  std::vector<VariantChoice> variants;
};

/// State shared by all diagrams of one load.
struct DiagramLoad {
  Problems& problems;
  DiagramLibrary library{problems};
  std::vector<std::string> opened{};      // the files being read, outermost first
  std::vector<std::string> identities{};  // of the same
  size_t block_count = 0;                 // of all diagrams

  std::shared_ptr<Diagram> load(const std::string& path, const Place& reference, Instance instance);
  /// A diagram that is defined in the file at `path`, where other diagrams name a file.
  std::shared_ptr<Diagram> read(const Value& root, const BlockList& blocks, const std::string& path,
                                Instance instance);
};

}  // namespace loopwright
