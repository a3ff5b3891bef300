/// Problems of an input, worded so that a user can correct them. Problems are collected, not thrown one by
/// one.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace loopwright {

class PointerTable;

/// The text of a file written by the user; places point into it.
struct SourceFile {
  std::string name;  ///< as the user gave it, for messages
  std::string text;
  mutable std::shared_ptr<const PointerTable> pointers{};  ///< of a JSON text; created on first use
};

/// A location in a file. Line, column and JSON pointer are computed only when a message is written.
struct Place {
  std::shared_ptr<const SourceFile> file;
  uint32_t offset = 0;

  /// "/blocks/feedback/Kp": the JSON pointer (RFC 6901) of the value at this location, or of the value named
  /// here.
  std::string pointer() const;
};

/// One token of a JSON pointer: a slash and the name.
std::string pointer_token(std::string_view name);

/// Line and column of a location, both counted from 1; columns count characters, not bytes.
struct LineColumn {
  int line = 1, column = 1;
};
LineColumn line_column(const Place& place);

/// One problem. Empty members are omitted from the message.
struct Problem {
  enum class Severity { warning, error };
  Severity severity = Severity::error;
  Place place;           ///< location in the file
  std::string pointer;   ///< JSON pointer, "/blocks/feedback/Kp"
  std::string block;     ///< path of the block, "stage.friction"
  std::string message;   ///< what is wrong
  std::string expected;  ///< what would be correct
  std::string found;     ///< what was found
  std::string hint;      ///< how to correct it
};

/// Text from a file in a form that a terminal may show. UTF-8 is kept. Control characters other than the end
/// of a line, and bytes that are not UTF-8, become \x1b and the like. Otherwise a file could move the cursor
/// or hide messages about it.
std::string printable(std::string_view text);

/// file:line:column: error: message … as shown to a user, printable, several lines without a trailing
/// newline.
std::string to_string(const Problem& problem);

/// The largest number of problems written out; the others are only counted.
constexpr size_t most_problems_told = 200;

/// Problems as shown to a user, sorted by file and location, each followed by a newline. If not all can be
/// shown, errors come before warnings.
std::string to_text(std::span<const Problem> problems);

/// A file whose contents determined the result.
struct FileRead {
  std::string path;  ///< as it was opened
  std::string hash;  ///< content_hash() of its bytes; empty: only named
};

/// The findings of one load: problems in the order in which they were found, and the files that were read.
class Problems {
 public:
  Problem& error(Place place, std::string pointer, std::string block, std::string message);
  Problem& warning(Place place, std::string pointer, std::string block, std::string message);
  void add(Problem problem) { list_.push_back(std::move(problem)); }
  /// Adds the findings of a part of the load.
  void add(const Problems& part);
  bool has_errors() const;
  const std::vector<Problem>& list() const { return list_; }
  /// The problems as in to_text(), followed by a line with their total number.
  std::string text() const;

  /// Every reader of a file must record it here.
  void note_file(const std::string& path, std::string_view bytes);
  /// Records a file that will be read later, with an empty hash.
  void note_file_name(const std::string& path) { files_.push_back({path, {}}); }
  const std::vector<FileRead>& files() const { return files_; }

 private:
  std::vector<Problem> list_;
  std::vector<FileRead> files_;
};

/// Thrown once at the end of a load that found errors: the program exits with code 2.
struct InputError : std::runtime_error {
  explicit InputError(Problems p) : std::runtime_error(p.text()), problems(std::move(p)) {}
  Problems problems;
};

/// The name among `candidates` that was probably meant; nothing if none is similar.
std::string nearest_name(std::string_view wrong, const std::vector<std::string>& candidates);

}  // namespace loopwright
