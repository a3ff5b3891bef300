/// Paths of files in a diagram, recognized by the meaning of the setting, never by the contents of a folder.
#pragma once
#include "engine/json/value.h"
#include "tools/effects/json_text.h"

namespace loopwright {

/// Rewrites every relative path in a diagram so that from `folder` it leads to the same file as before: paths
/// of subdiagrams, of parameters of the kind `file`, of diagram parameters that such a parameter reads
/// ("=model"), and of "$schema". The file need not exist. The contents of other files are not changed.
void rebase_paths(const Value& diagram, const std::string& folder, TextEdits& edits);

}  // namespace loopwright
