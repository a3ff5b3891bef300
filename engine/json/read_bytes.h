/// Reads any file that a file of the user names.
#pragma once
#include <memory>
#include <string>
#include "engine/json/problem.h"

namespace loopwright {

/// The bytes of a regular file of at most `largest` bytes; null after a problem, which is reported at
/// `reference` (where the file was named). The file is recorded in `problems` as read.
std::shared_ptr<const SourceFile> read_bytes(const std::string& path, const Place& reference, size_t largest,
                                             Problems& problems);

}  // namespace loopwright
