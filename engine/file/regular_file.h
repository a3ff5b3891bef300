/// Reads whole regular files into memory. A file without end, one that makes its reader wait, or one that the
/// program is going to write (output_files.h), is refused immediately.
#pragma once
#include <cstddef>
#include <string>

namespace loopwright {

/// The reason why a path does not name a regular file that can be opened ("it is a named pipe"); empty if it
/// does. Never waits for another process.
std::string why_not_regular(const std::string& path);

/// Reads a regular file of at most `largest` bytes into `bytes`. Returns the reason for a failure; empty on
/// success.
std::string read_regular_file(const std::string& path, size_t largest, std::string& bytes);

}  // namespace loopwright
