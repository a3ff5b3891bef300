/// Whole files into memory.
#pragma once
#include <memory>
#include <string>

#include "engine/json/problem.h"

namespace loopwright {

/// The bytes of a regular file or a pipe. What cannot be opened or read, or is larger than the 4 GiB that a
/// Place can point into, is an error; the file then comes back empty.
std::shared_ptr<const SourceFile> read_input_file(const std::string& path, Problems& problems);

}  // namespace loopwright
