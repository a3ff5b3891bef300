/// Measurements are not part of the repository. This finds the data files that other files name.
#pragma once
#include <functional>
#include <string>
#include "engine/json/problem.h"

namespace loopwright {

/// The path of a data file: beside the file that names it; else below $LOOPWRIGHT_DATA, if that is set; else in one
/// of the folders there. Empty, with a problem, if it is nowhere, or in several of these folders.
std::string find_data_file(const std::string& named_in, const std::string& name,
                           const std::function<Problem&(std::string message)>& problem);

}  // namespace loopwright
