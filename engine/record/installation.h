/// Where the program lies, and with it what came with it: it may be moved, or installed, as a whole.
#pragma once
#include <string>
#include <string_view>

namespace loopwright {

/// `PREFIX/lib/<name>` for a program PREFIX/bin/loopwright.
std::string library_file(std::string_view name);

/// `PREFIX/share/loopwright/<name>`; in a build tree the link `share/loopwright` leads to the sources.
std::string shared_file(std::string_view name);

}  // namespace loopwright
