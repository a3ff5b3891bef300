/// Paths of files in a diagram, told by what their place is for, never by what happens to lie in a folder.
#pragma once
#include "engine/json/value.h"
#include "tools/effects/json_text.h"

namespace loopwright {

/// Rewrites every relative path in a diagram so that it leads from `folder` to the file to which it leads
/// now: those of subdiagrams, of parameters of the kind `file`, of the diagram's parameters that such a one
/// reads
/// ("=model"), and of "$schema". Whether the file exists does not matter. Texts of further files are not
/// touched: they keep their own places.
void rebase_paths(const Value& diagram, const std::string& folder, TextEdits& edits);

}  // namespace loopwright
