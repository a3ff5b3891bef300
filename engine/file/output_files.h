/// Files that the program is going to write. None of them is read: a recording that replaced its own input
/// would destroy it.
#pragma once
#include <sys/stat.h>

#include <string>

namespace loopwright {

/// Whether two paths lead to the same file: the same device and inode, or the same path if neither exists.
bool is_same_file(const std::string& a, const std::string& b);

/// From now on reading the regular file at this path, if there is one, is refused (see regular_file.h) with
/// `option`, the command line option that names it. Called before other threads start.
void reserve_for_output(const std::string& path, const std::string& option);

/// The reason why an existing file cannot be read; empty for a file that is not reserved.
std::string why_reserved(const struct stat& file);

}  // namespace loopwright
