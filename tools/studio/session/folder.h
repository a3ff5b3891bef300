/// The folder that the studio serves. No path of a request leads out of it.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace loopwright::studio {

/// Closes a file descriptor.
class Handle {
 public:
  explicit Handle(int number = -1) : number_(number) {}
  Handle(Handle&& other) noexcept : number_(other.number_) { other.number_ = -1; }
  Handle& operator=(Handle&& other) noexcept;
  ~Handle();
  int number() const { return number_; }
  explicit operator bool() const { return number_ >= 0; }

 private:
  int number_;
};

class Folder {
 public:
  /// Throws std::runtime_error if there is no such folder.
  explicit Folder(std::string path);
  const std::string& path() const { return path_; }

  /// The path of a file for reading, DIR/axis.json. Throws Refused for a path that is absolute, has "..", a
  /// hidden part or a suffix that the studio does not know. A symbolic link is followed.
  std::string path_of(const std::string& relative) const;
  /// The path of a request for a path that path_of() gave.
  std::string relative(const std::string& path) const;
  /// Whether the file, or its folder if there is none, is below DIR without any symbolic link.
  bool is_writable(const std::string& relative) const;

  /// The contents of a file below DIR; nothing if there is none. Throws Refused for one that cannot be read.
  std::optional<std::string> read(const std::string& relative) const;

  /// Replaces `expected` (nothing: there is no file) by `text`, completely or not at all. If the file has
  /// other contents it stays as it is, and these are returned; an empty result: it is written. Whatever
  /// another program writes meanwhile is either found here or written over `text` by that program, never
  /// lost. Throws Refused if the file cannot be written.
  struct Found {
    std::optional<std::string> text;  ///< nothing: the file is gone
  };
  std::optional<Found> replace(const std::string& relative, const std::optional<std::string>& expected,
                               std::string_view text) const;

  /// Removes a file that still has these contents.
  void remove(const std::string& relative, std::string_view expected) const;

  /// Creates DIR/.loopwright, or a folder in it. Files in it may be read and written with their path.
  void make_own_folder(const std::string& name) const;

  /// Writes a part of a new file, from `offset` on; the last part gives it its name. Throws Refused, also if
  /// there is such a file with other contents.
  void store_part(const std::string& name, int64_t offset, bool is_last, std::string_view bytes) const;

  struct File {
    std::string path;
    int64_t size = 0;
  };
  /// Every file with a known suffix, sorted, at most a few thousand; hidden ones and layout files left out.
  std::vector<File> files() const;

 private:
  Handle folder_of(const std::string& relative, std::string& name) const;

  std::string path_;
  Handle handle_;
};

}  // namespace loopwright::studio
