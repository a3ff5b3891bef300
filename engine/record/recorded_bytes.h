/// The bytes of a recording's file.
#pragma once
#include <memory>
#include <string>

#include "engine/json/problem.h"

namespace loopwright {

/// The bytes of a regular file of at most 4 GiB, the range of a Place; null after a problem. The file is
/// recorded in `problems` as read.
std::shared_ptr<const SourceFile> read_recorded_bytes(const std::string& path, Problems& problems);

}  // namespace loopwright
