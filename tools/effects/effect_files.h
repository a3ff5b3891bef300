/// The effect files of a folder.
#pragma once
#include <string>
#include <vector>
#include "engine/json/problem.h"

namespace loopwright {

/// Sorted by name. A problem if the folder is not there.
std::vector<std::string> effect_files(const std::string& folder, Problems& problems);

/// The catalogue installed with the program, see shared_file.
std::string installed_catalogue();

}  // namespace loopwright
