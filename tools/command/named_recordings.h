/// Recordings named after their files, as pages show them.
#pragma once
#include "tools/run/scopes.h"

namespace loopwright {

/// File names without their folders, where that distinguishes them; otherwise the paths. The recordings must
/// outlive the result.
std::vector<NamedRecording> named(const std::vector<std::string>& paths,
                                  const std::vector<Recording>& recordings);

/// Recordings for a page: the time is the first column, in s, wherever it stands in the file; a warning names
/// a first column that is only taken for the time. Throws InputError with every problem of every file.
std::vector<Recording> read_for_page(const std::vector<std::string>& paths);

/// Columns of the same name get the unit of the first recording, as do the times. Those of another dimension
/// stay as they are. The time of the other becomes its first column; throws InputError if it has none.
void convert_to_units_of(const Recording& first, Recording& other);

}  // namespace loopwright
