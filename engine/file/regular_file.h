/// Whole files into memory, and only files: what has no end, or makes its reader wait, is refused at once.
#pragma once
#include <cstddef>
#include <string>

namespace loopwright {

/// Why a path names no regular file that can be opened ("it is a named pipe"); empty when it does. It never
/// waits for another process.
std::string why_not_regular(const std::string& path);

/// Puts the contents of a regular file of at most `largest` bytes into `bytes`. Returns why it could not; empty
/// when all went well.
std::string read_regular_file(const std::string& path, size_t largest, std::string& bytes);

}  // namespace loopwright
