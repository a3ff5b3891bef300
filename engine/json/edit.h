/// `--set path=value`: a change to the contents of a diagram file, made before its expressions are evaluated.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>
#include "engine/json/reader.h"

namespace loopwright {

struct Edit {
  std::vector<std::string> path;  ///< "stage", "payload"
  size_t depth = 0;               ///< number of names that lead to the present diagram
  Value value;

  const std::string& head() const { return path[depth]; }
  bool is_last() const { return depth + 1 == path.size(); }
  Edit inside() const { return {path, depth + 1, value}; }
  std::string text() const;  ///< the whole path with dots
};

/// Nothing after a problem.
std::optional<Edit> read_edit(const std::pair<std::string, std::string>& option, Problems& problems);

/// The same of a file, path → value: problems name its place there.
std::optional<Edit> read_edit(const Value::Member& setting, Problems& problems);

/// Sets the member or item of `value` at the remaining path, from `depth` on. A missing member is added, as
/// it may have a default; an index must exist in the list. A bare number takes the unit of the number that it
/// replaces. `contents` is called for every value on the way, so that one that stands in another file is
/// changed like one that is written here.
void apply_edit(const Edit& edit, Value& value, const Reader& reader,
                const std::function<void(Value&)>& contents = nullptr);

}  // namespace loopwright
