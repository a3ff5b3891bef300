/// Recordings named after their files, as pages show them.
#pragma once
#include "tools/run/scopes.h"

namespace loopwright {

/// File names without their folders, where that distinguishes them; otherwise the paths. The recordings must
/// outlive the result.
std::vector<NamedRecording> named(const std::vector<std::string>& paths,
                                  const std::vector<Recording>& recordings);

/// Columns of the same name get the unit of the first recording, as do the times. Those of another dimension
/// stay as they are.
void convert_to_units_of(const Recording& first, Recording& other);

}  // namespace loopwright
