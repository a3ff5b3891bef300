/// What a JSON file is, told by its keys: so that a file in the wrong place is named for what it is.
#pragma once
#include <string>
#include <string_view>
#include "engine/json/problem.h"
#include "engine/json/value.h"

namespace loopwright {

enum class FileKind { unknown, diagram, experiment, sweep, training, effect, device, model };

/// "a diagram", "an experiment", …
std::string_view with_article(FileKind kind);

/// By the keys that no other kind has; `unknown` when there is none.
FileKind kind_of(const Value& file);

/// The same of a file, which is read no further than it must be; problems when it cannot be read.
FileKind kind_of_file(const std::string& path, Problems& problems);

/// False, and a problem at the key that tells, when a file is plainly of another kind than the reader's.
bool expect_kind(const Value& file, FileKind wanted, Problems& problems);

}  // namespace loopwright
