/// Measurements are not part of the repository. This finds the data files that other files name.
#pragma once
#include <string>
#include <vector>

namespace loopwright {

/// The path of a data file: beside the file that names it; else below $LOOPWRIGHT_DATA (../shared/data if not
/// set), including its folders. Empty if not found; `tried` then lists where it was searched.
std::string find_data_file(const std::string& named_in, const std::string& name,
                           std::vector<std::string>& tried);

}  // namespace loopwright
