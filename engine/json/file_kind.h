/// The kind of a JSON file, determined by its keys, so that messages can name the kind of a wrong file.
#pragma once
#include <string>
#include <string_view>
#include "engine/json/problem.h"
#include "engine/json/value.h"

namespace loopwright {

enum class FileKind { unknown, diagram, experiment, sweep, training, effect, device, model };

/// "a diagram", "an experiment", …
std::string_view with_article(FileKind kind);

/// Determined by keys that no other kind has; `unknown` if there is none.
FileKind kind_of(const Value& file);

/// The same for a file, which is read only as far as necessary; problems if it cannot be read.
FileKind kind_of_file(const std::string& path, Problems& problems);

/// If a file is clearly of another kind than `wanted`: false, and a problem at the key that shows it.
bool expect_kind(const Value& file, FileKind wanted, Problems& problems);

}  // namespace loopwright
