/// The location of the program and of the files installed with it, which may be moved as a whole.
#pragma once
#include <string>
#include <string_view>

namespace loopwright {

/// Where PREFIX is for code that another program has loaded, such as an interpreter. To be called before the functions
/// below; otherwise PREFIX is the parent of the folder of the running program.
void set_prefix(std::string prefix);

/// `PREFIX/lib/<name>` for a program PREFIX/bin/loopwright.
std::string library_file(std::string_view name);

/// `PREFIX/share/loopwright/<name>`; in a build tree the link `share/loopwright` points to the sources.
std::string shared_file(std::string_view name);

}  // namespace loopwright
