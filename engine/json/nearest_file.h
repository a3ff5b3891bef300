/// A hint for the name of a file that does not exist.
#pragma once
#include <string>

namespace loopwright {

/// "did you mean "dir/loop.json"?", the file in the same folder with the same extensions whose name is most
/// similar; empty if there is none.
std::string nearest_file_hint(const std::string& path);

}  // namespace loopwright
