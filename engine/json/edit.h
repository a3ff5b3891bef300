/// `--set path=value`: a change to what a diagram file says, made before its expressions are worked out.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>
#include "engine/json/reader.h"

namespace loopwright {

struct Edit {
  std::vector<std::string> path;  ///< "stage", "payload"
  size_t depth = 0;               ///< names that lead to the diagram in hand
  Value value;

  const std::string& head() const { return path[depth]; }
  bool is_last() const { return depth + 1 == path.size(); }
  Edit inside() const { return {path, depth + 1, value}; }
  std::string text() const;  ///< the whole path with dots
};

/// Nothing after a problem.
std::optional<Edit> read_edit(const std::pair<std::string, std::string>& option, Problems& problems);

/// Sets the member or item of `value` that the rest of the path, from `depth` on, leads to. A member that is
/// not there is added, as it may have a default; an index must be one of the list.
void apply_edit(const Edit& edit, Value& value, const Reader& reader);

}  // namespace loopwright
