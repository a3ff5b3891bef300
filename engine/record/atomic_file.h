/// Files that are there whole or not at all.
#pragma once
#include <string>
#include <string_view>

namespace loopwright {

/// Writes to a temporary file in the target's folder; commit() brings it to the disk and renames it over the
/// target. Without commit() the target stays as it was and the temporary file is removed; one that a killed
/// program left is removed by the next that writes the same target.
///
/// A symbolic link is followed, and permissions of a replaced file are kept. A target that is no regular
/// file, such as /dev/stdout or a pipe, is written to directly: it cannot be replaced. Every failure throws
/// std::runtime_error naming the target and the reason (full disk, no permission, …).
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

/// The whole file in one call.
void write_file(const std::string& path, std::string_view bytes);

}  // namespace loopwright
