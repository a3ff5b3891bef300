/// Files that are written completely or not at all.
#pragma once
#include <string>
#include <string_view>

namespace loopwright {

/// Writes to a temporary file in the folder of the target; commit() synchronizes it to disk and renames it to
/// the target. Without commit() the target is unchanged and the temporary file is removed. A temporary file
/// left by a terminated program is removed when the same target is written again.
///
/// A symbolic link is followed, and the permissions of a replaced file are kept. A target that is not a
/// regular file, such as /dev/stdout or a pipe, is written directly, as it cannot be replaced. Every failure
/// throws std::runtime_error with the target and the reason (full disk, no permission, …).
class AtomicFile {
 public:
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);
  void commit();

 private:
  [[noreturn]] void fail(int error_number) const;

  std::string path_;       ///< as the user gave it, for messages
  std::string target_;     ///< with symbolic links followed
  std::string temporary_;  ///< empty: nothing to rename or remove
  int file_ = -1;
};

/// Writes a whole file in one call.
void write_file(const std::string& path, std::string_view bytes);

}  // namespace loopwright
