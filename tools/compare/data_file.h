/// Measurements are not part of the repository: where a file that names them finds them.
#pragma once
#include <string>
#include <vector>

namespace loopwright {

/// The path of a data file: beside the file that names it; else below $LOOPWRIGHT_DATA (../shared/data when
/// that is not set), also in its folders. Empty when it is nowhere; `tried` then says where it was looked
/// for.
std::string find_data_file(const std::string& named_in, const std::string& name,
                           std::vector<std::string>& tried);

}  // namespace loopwright
