/// Numbers of a diagram file by the paths that `--set` takes.
#pragma once
#include <memory>
#include "tools/effects/json_text.h"

namespace loopwright {

/// Replaces the number at a path, a value in SI, in the unit that is written beside it. A problem if the path
/// leads to the file of a subdiagram, or to an expression. `root` is the parsed file.
void write_number(const std::shared_ptr<const SourceFile>& file, const Value& root, const std::string& path,
                  double value, TextEdits& edits, Problems& problems);

}  // namespace loopwright
