/// Recordings named after their files, as pages show them.
#pragma once
#include "tools/run/scopes.h"

namespace loopwright {

/// File names without their folders, where that distinguishes them; otherwise the paths. The recordings must
/// outlive the result.
std::vector<NamedRecording> named(const std::vector<std::string>& paths,
                                  const std::vector<Recording>& recordings);

}  // namespace loopwright
